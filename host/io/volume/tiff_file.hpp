// An open TIFF file: libtiff, whose errors become clvr's, and the bytes themselves where libtiff does not look.
#pragma once
#include "host/io/volume/samples.hpp"

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct tiff; // libtiff's TIFF

namespace clvr {

/// One page as the list of directories shows it; its form may still be one that clvr does not read.
struct TiffPage {
    std::uint64_t at = 0; ///< where its directory is
    std::uint32_t width = 0, height = 0;
    bool is_extra = false; ///< a reduced image (thumbnail, pyramid level) or a mask
};

/// An entry of a directory as it stands in the file.
struct TiffEntry {
    std::uint16_t type = 0;
    std::uint64_t count = 0, value_at = 0; ///< `value_at`: where its first value is in the file
};

class TiffFile {
public:
    /// Throws Error{input} for what is no TIFF.
    explicit TiffFile(const std::string& path);
    TiffFile(const TiffFile&) = delete;
    TiffFile& operator=(const TiffFile&) = delete;

    tiff* get() const { return handle_.get(); }
    const std::string& path() const { return path_; }
    std::uint64_t size() const { return size_; }
    bool is_big_endian() const;

    /// A value of the current page, or `fallback`: tags of 16 or of 32 bits.
    template <class T>
    T field(std::uint32_t tag, T fallback) const;
    /// A text of the current page; empty where there is none.
    std::string text(std::uint32_t tag) const;
    /// An entry of the current page's directory.
    std::optional<TiffEntry> entry(std::uint16_t tag) const;
    /// `count` bytes from `offset`. Throws Error{input} where the file is shorter.
    std::string bytes(std::uint64_t offset, std::uint64_t count) const;
    /// An unsigned integer of 1, 2, 4 or 8 bytes, or a double, in the file's byte order.
    std::uint64_t integer(std::uint64_t offset, std::size_t bytes) const;
    double real(std::uint64_t offset) const;

    /// All pages of the main list, in order. Throws Error{input} where the list breaks off.
    std::vector<TiffPage> pages() const;
    /// Makes the page whose directory is there the current one.
    void select(const TiffPage& page) const;
    /// Throws Error{input} with what libtiff complained of last.
    [[noreturn]] void fail() const;
    /// Throws Error{input} where libtiff had to guess where the pixels of the current (selected) page are.
    void check_counts() const;

private:
    static int complain(tiff*, void* self, const char*, const char* format, va_list arguments);
    static int warn(tiff*, void* self, const char*, const char* format, va_list arguments);
    void check_link() const;

    std::string path_, complaint_;
    mutable std::string guess_; ///< libtiff's warning of wrong byte counts in the current page
    std::uint64_t size_ = 0;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> raw_;
    std::unique_ptr<tiff, void (*)(tiff*)> handle_;
};

} // namespace clvr
