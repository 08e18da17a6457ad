// SHA-256 (FIPS 180-4), used to identify the inputs of a result.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // of OpenSSL

namespace mcdem::inline core {

class Sha256 {
public:
    Sha256();
    Sha256& add(std::string_view text);
    Sha256& add(std::span<const double> numbers);
    /// 64 hexadecimal digits of the digest. Do not call add afterwards.
    std::string hex();

private:
    std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

}  // namespace mcdem::core
