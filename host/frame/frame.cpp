#include "host/frame/frame.hpp"
#include "runtime/error.hpp"

#include <cstdint>
#include <fmt/format.h>
#include <memory>
#include <openssl/evp.h>

namespace clvr {

std::string pixel_hash(const Frame& frame) {
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    const auto add = [&](const void* bytes, std::size_t size) {
        if (EVP_DigestUpdate(context.get(), bytes, size) != 1) throw Error(ErrorKind::internal, "SHA-256 failed");
    };
    if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1)
        throw Error(ErrorKind::internal, "SHA-256 is not available");
    const std::uint32_t size[2] = {static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height)};
    add(size, sizeof size);
    for (const auto& [name, values] : frame.channels) {
        add(name.c_str(), name.size() + 1);
        add(values.data(), values.size() * sizeof(float));
    }
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned length = 0;
    if (EVP_DigestFinal_ex(context.get(), digest, &length) != 1) throw Error(ErrorKind::internal, "SHA-256 failed");
    std::string hex;
    for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
    return hex;
}

} // namespace clvr
