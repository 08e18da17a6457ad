#include "core/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>

#include "core/errors.h"

namespace mcdem::inline core {
namespace {

void expect(int success) {
    if (success != 1) throw RunError("SHA-256 is not available in this installation of OpenSSL");
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    expect(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

Sha256& Sha256::add(std::string_view text) {
    expect(EVP_DigestUpdate(context_.get(), text.data(), text.size()));
    return *this;
}

Sha256& Sha256::add(std::span<const double> numbers) {
    expect(EVP_DigestUpdate(context_.get(), numbers.data(), numbers.size_bytes()));
    return *this;
}

std::string Sha256::hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned int size = 0;
    expect(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size));
    return fmt::format("{:02x}", fmt::join(bytes.data(), bytes.data() + size, ""));
}

}  // namespace mcdem::core
