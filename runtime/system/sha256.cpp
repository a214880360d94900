#include "runtime/system/sha256.hpp"

#include "runtime/error.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

namespace clvr {

std::string sha256_hex(std::string_view bytes) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned length = 0;
    if (EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr) != 1)
        throw Error(ErrorKind::internal, "OpenSSL offers no SHA-256");
    std::string hex;
    for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
    return hex;
}

std::string sha256_hex(std::initializer_list<std::string_view> parts) {
    std::string joined;
    for (const std::string_view part : parts) joined += fmt::format("{}:{}", part.size(), part);
    return sha256_hex(joined);
}

} // namespace clvr
