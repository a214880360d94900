// SHA-256 and SHA-512, of texts, of lists of texts, of bytes that come in pieces.
#pragma once
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>

namespace clvr {

/// A hash of bytes that come in pieces.
class Hash {
public:
    enum class Kind { sha256, sha512 };
    explicit Hash(Kind kind = Kind::sha256);
    Hash(Hash&&) noexcept;
    ~Hash();
    Hash& add(const void* bytes, std::size_t size);
    Hash& add(std::string_view text) { return add(text.data(), text.size()); }
    /// Lower-case hexadecimal digits, 64 or 128. Ends the hash.
    std::string hex();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

/// Of the parts, each with its length before it, so that no two lists have the same bytes.
std::string sha256_hex(std::initializer_list<std::string_view> parts);

} // namespace clvr
