#include "host/io/volume/tiff_file.hpp"
#include "host/io/file_roles.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <sys/types.h>
#include <tiffio.h>

namespace clvr {

namespace {

/// One line.
std::string text_of(const char* format, va_list arguments) {
    char buffer[256];
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    std::string text(buffer);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

} // namespace

TiffFile::TiffFile(const std::string& path) : path_(path), raw_(nullptr, &std::fclose), handle_(nullptr, &TIFFClose) {
    will_read(path);
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), &TiffFile::complain, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), &TiffFile::warn, this);
    // m: not mapped into memory, where the file would count a second time.
    handle_.reset(TIFFOpenExt(path.c_str(), "rm", options.get()));
    if (!handle_) {
        const std::string head = read_head(path, 4);
        const std::array marks{std::string("II*\0", 4), std::string("MM\0*", 4), std::string("II+\0", 4), std::string("MM\0+", 4)};
        if (std::find(marks.begin(), marks.end(), head) == marks.end()) bad_file(path, "is no TIFF: it does not start as one");
        fail();
    }
    size_ = std::filesystem::file_size(path);
    raw_.reset(std::fopen(path.c_str(), "rb"));
    if (!raw_) bad_file(path, "cannot be opened");
}

int TiffFile::complain(TIFF*, void* self, const char*, const char* format, va_list arguments) {
    static_cast<TiffFile*>(self)->complaint_ = text_of(format, arguments);
    return 1;
}

/// Most warnings are of unknown tags; that of byte counts means that libtiff guesses where the pixels are.
int TiffFile::warn(TIFF*, void* self, const char*, const char* format, va_list arguments) {
    if (std::strstr(format, "ByteCount")) static_cast<TiffFile*>(self)->guess_ = text_of(format, arguments);
    return 1;
}

void TiffFile::check_counts() const {
    if (!guess_.empty()) bad_file(path_, "its byte counts are wrong ({}): the file is truncated or damaged", guess_);
}

void TiffFile::fail() const {
    bad_file(path_, "it does not decode ({}): the file is truncated or damaged", complaint_.empty() ? "no reason given" : complaint_);
}

bool TiffFile::is_big_endian() const { return TIFFIsBigEndian(get()) != 0; }

template <class T>
T TiffFile::field(std::uint32_t tag, T fallback) const {
    T value = fallback;
    return TIFFGetFieldDefaulted(get(), tag, &value) ? value : fallback;
}
template std::uint16_t TiffFile::field(std::uint32_t tag, std::uint16_t fallback) const;
template std::uint32_t TiffFile::field(std::uint32_t tag, std::uint32_t fallback) const;

std::string TiffFile::text(std::uint32_t tag) const {
    const char* text = nullptr;
    return TIFFGetField(get(), tag, &text) && text ? text : "";
}

std::string TiffFile::bytes(std::uint64_t offset, std::uint64_t count) const {
    if (offset > size_ || count > size_ - offset)
        bad_file(path_, "expected {} bytes from byte {} on, the file has {}: it is truncated or damaged", count, offset, size_);
    std::string bytes(count, '\0');
    if (fseeko(raw_.get(), static_cast<off_t>(offset), SEEK_SET) != 0 || std::fread(bytes.data(), 1, count, raw_.get()) != count)
        bad_file(path_, "cannot be read at byte {}", offset);
    return bytes;
}

std::uint64_t TiffFile::integer(std::uint64_t offset, std::size_t count) const {
    const std::string b = bytes(offset, count);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(b[is_big_endian() ? i : count - 1 - i]);
    return value;
}

double TiffFile::real(std::uint64_t offset) const {
    const std::uint64_t bits = integer(offset, 8);
    double value;
    std::memcpy(&value, &bits, 8);
    return value;
}

std::optional<TiffEntry> TiffFile::entry(std::uint16_t tag) const {
    const bool wide = TIFFIsBigTIFF(get());
    const std::uint64_t at = TIFFCurrentDirOffset(get()), entries = integer(at, wide ? 8 : 2), first = at + (wide ? 8 : 2);
    const std::size_t entry_bytes = wide ? 20 : 12, word = wide ? 8 : 4;
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(entries, 65535); ++i) {
        const std::uint64_t here = first + i * entry_bytes;
        if (integer(here, 2) != tag) continue;
        // Bytes of the TIFF types 0 to 18.
        constexpr std::array<std::uint64_t, 19> type_bytes{1, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 1, 1, 8, 8, 8};
        TiffEntry e;
        e.type = static_cast<std::uint16_t>(integer(here + 2, 2));
        e.count = integer(here + 4, word);
        const std::uint64_t each = e.type < type_bytes.size() ? type_bytes[e.type] : 1;
        const std::uint64_t value = here + 4 + word;
        e.value_at = e.count <= word / each ? value : integer(value, word);
        return e;
    }
    return std::nullopt;
}

/// libtiff takes a directory for the last one where its link to the next is cut off; so this checks that the file holds the link.
void TiffFile::check_link() const {
    const bool wide = TIFFIsBigTIFF(get());
    const std::uint64_t at = TIFFCurrentDirOffset(get()), entries = integer(at, wide ? 8 : 2);
    const std::uint64_t end = at + (wide ? 8 : 2) + entries * (wide ? 20 : 12) + (wide ? 8 : 4);
    if (end > size_) bad_file(path_, "page {} ends at byte {}, the file has {}: it is truncated", TIFFCurrentDirectory(get()), end, size_);
}

std::vector<TiffPage> TiffFile::pages() const {
    std::vector<TiffPage> pages;
    if (!TIFFSetDirectory(get(), 0)) fail();
    do {
        TiffPage p;
        p.at = TIFFCurrentDirOffset(get());
        if (!TIFFGetField(get(), TIFFTAG_IMAGEWIDTH, &p.width) || !TIFFGetField(get(), TIFFTAG_IMAGELENGTH, &p.height))
            bad_file(path_, "page {} has no size", pages.size());
        p.is_extra = (field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) != 0;
        check_link();
        pages.push_back(p);
    } while (TIFFReadDirectory(get()));
    if (!complaint_.empty()) fail();
    return pages;
}

void TiffFile::select(const TiffPage& page) const {
    guess_.clear();
    if (!TIFFSetSubDirectory(get(), page.at)) fail();
}

} // namespace clvr
