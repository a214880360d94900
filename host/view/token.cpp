#include "host/view/token.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <openssl/crypto.h>
#include <sys/random.h>
#include <sys/stat.h>

namespace clvr::view {

std::string new_token() {
    std::array<unsigned char, 32> bytes{};
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) // up to 256 bytes come whole, or none
        throw Error(ErrorKind::internal, fmt::format("the operating system has no random bytes: {}", std::strerror(errno)));
    std::string hex;
    for (const unsigned char byte : bytes) hex += fmt::format("{:02x}", byte);
    return hex;
}

bool same_token(const std::string& a, const std::string& b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

void write_token_file(const std::string& path, const std::string& token) {
    write_atomically(path, [&](const std::string& temporary) {
        if (chmod(temporary.c_str(), 0600) != 0)
            throw Error(ErrorKind::input, fmt::format("cannot be kept from other users: {}", std::strerror(errno)), path);
        if (!(std::ofstream(temporary) << token << "\n" << std::flush)) throw Error(ErrorKind::input, "cannot be written", path);
    });
}

} // namespace clvr::view
