#include "runtime/system/hashes.hpp"

#include "runtime/error.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

namespace clvr {
namespace {

void require(bool good) {
    if (!good) throw Error(ErrorKind::internal, "OpenSSL offers no SHA-256 or SHA-512");
}

} // namespace

struct Hash::State {
    std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

Hash::Hash(Kind kind) : state_(std::make_unique<State>()) {
    require(state_->context && EVP_DigestInit_ex(state_->context.get(), kind == Kind::sha256 ? EVP_sha256() : EVP_sha512(), nullptr) == 1);
}
Hash::Hash(Hash&&) noexcept = default;
Hash::~Hash() = default;

Hash& Hash::add(const void* bytes, std::size_t size) {
    require(EVP_DigestUpdate(state_->context.get(), bytes, size) == 1);
    return *this;
}

std::string Hash::hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned length = 0;
    require(EVP_DigestFinal_ex(state_->context.get(), digest, &length) == 1);
    std::string hex;
    for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
    return hex;
}

std::string sha256_hex(std::string_view bytes) { return Hash().add(bytes).hex(); }

std::string sha256_hex(std::initializer_list<std::string_view> parts) {
    Hash hash;
    for (const std::string_view part : parts) hash.add(fmt::format("{}:{}", part.size(), part));
    return hash.hex();
}

} // namespace clvr
