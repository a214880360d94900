// Numbers of binary headers.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string>

namespace clvr {

/// The bytes of a header as numbers: T lies at a byte offset, in this machine's byte order or `swapped`.
class HeaderBytes {
public:
    HeaderBytes(std::string bytes, bool swapped) : bytes_(std::move(bytes)), swapped_(swapped) {}
    /// The number at `offset`, which must lie within the bytes.
    template <class T>
    T at(std::size_t offset) const {
        std::array<char, sizeof(T)> raw;
        std::copy_n(bytes_.data() + offset, sizeof(T), raw.begin());
        if (swapped_) std::reverse(raw.begin(), raw.end());
        T value;
        std::memcpy(&value, raw.data(), sizeof(T));
        return value;
    }
    /// The text of `size` bytes at `offset`, up to its first zero.
    std::string text(std::size_t offset, std::size_t size) const {
        const std::string field = bytes_.substr(offset, size);
        return field.substr(0, field.find('\0'));
    }
    bool swapped() const { return swapped_; }

private:
    std::string bytes_;
    bool swapped_;
};

} // namespace clvr
