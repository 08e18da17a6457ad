#include "core/sha256.h"

#include <openssl/evp.h>

#include <array>

#include "core/errors.h"

namespace mcdem::inline core {

struct Sha256::Context {
    EVP_MD_CTX* handle = EVP_MD_CTX_new();
    ~Context() { EVP_MD_CTX_free(handle); }
};

namespace {
void expect(int success) {
    if (success != 1) throw RunError("SHA-256 is not available in this installation of OpenSSL");
}
}  // namespace

Sha256::Sha256() : context_(std::make_unique<Context>()) {
    expect(EVP_DigestInit_ex(context_->handle, EVP_sha256(), nullptr));
}
Sha256::~Sha256() = default;

Sha256& Sha256::add(std::string_view text) {
    expect(EVP_DigestUpdate(context_->handle, text.data(), text.size()));
    return *this;
}

Sha256& Sha256::add(std::span<const double> numbers) {
    expect(EVP_DigestUpdate(context_->handle, numbers.data(), numbers.size_bytes()));
    return *this;
}

std::string Sha256::hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned int size = 0;
    expect(EVP_DigestFinal_ex(context_->handle, bytes.data(), &size));
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
        text += "0123456789abcdef"[bytes[i] >> 4];
        text += "0123456789abcdef"[bytes[i] & 15];
    }
    return text;
}

}  // namespace mcdem::core
