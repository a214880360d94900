// TIFF stacks through libtiff, whose every error is one of clvr's.
#include "host/io/file_roles.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <tiffio.h>

namespace clvr {

namespace {

/// An open TIFF file that remembers what libtiff complained of last.
class TiffFile {
public:
    explicit TiffFile(const std::string& path) : path_(path), handle_(nullptr, &TIFFClose) {
        will_read(path);
        const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), &TiffFile::complain, this);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), &TiffFile::warn, this);
        // m: not mapped into memory, where the file would count a second time.
        handle_.reset(TIFFOpenExt(path.c_str(), "rm", options.get()));
        if (!handle_) fail();
    }
    TIFF* get() const { return handle_.get(); }
    const std::string& path() const { return path_; }
    const std::string& complaint() const { return complaint_; }
    [[noreturn]] void fail() const {
        bad_file(path_, "libtiff cannot read it: {}; the file is truncated or damaged",
                 complaint_.empty() ? "no reason given" : complaint_);
    }
    template <class T>
    T field(ttag_t tag, T fallback) const {
        T value = fallback;
        return TIFFGetFieldDefaulted(get(), tag, &value) ? value : fallback;
    }

private:
    static int complain(TIFF*, void* self, const char*, const char* format, va_list arguments) {
        char text[256];
        std::vsnprintf(text, sizeof text, format, arguments);
        static_cast<TiffFile*>(self)->complaint_ = text;
        return 1;
    }
    /// Most warnings are of unknown tags; that of byte counts means that libtiff guesses where the pixels are.
    static int warn(TIFF* tiff, void* self, const char* module, const char* format, va_list arguments) {
        return std::strstr(format, "ByteCount") ? complain(tiff, self, module, format, arguments) : 1;
    }

    std::string path_, complaint_;
    std::unique_ptr<TIFF, void (*)(TIFF*)> handle_;
};

struct Page {
    std::uint32_t width = 0, height = 0;
    SampleType type = SampleType::u8;
    bool white_is_zero = false;
};

bool operator==(const Page& a, const Page& b) {
    return a.width == b.width && a.height == b.height && a.type == b.type && a.white_is_zero == b.white_is_zero;
}

SampleType sample_type(const TiffFile& file) {
    const auto bits = file.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1),
               format = file.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    const char kind = format == SAMPLEFORMAT_IEEEFP                                ? 'f'
                      : format == SAMPLEFORMAT_INT                                 ? 'i'
                      : format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID ? 'u'
                                                                                   : '?';
    const auto type = parse_sample_type(fmt::format("{}{}", kind, bits));
    if (!type)
        bad_file(file.path(),
                 "pixels of {} bits in TIFF sample format {} are not read: expected 8, 16, 32 or 64 bit integers, or 32 or 64 bit floats",
                 bits, format);
    return *type;
}

Page page_of(const TiffFile& file) {
    Page p;
    if (!TIFFGetField(file.get(), TIFFTAG_IMAGEWIDTH, &p.width) || !TIFFGetField(file.get(), TIFFTAG_IMAGELENGTH, &p.height))
        bad_file(file.path(), "a page has no size");
    const auto samples = file.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    const auto photometric = file.field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    if (samples != 1 || photometric == PHOTOMETRIC_RGB)
        bad_file(file.path(), "the pixels have {} channels (colour): clvr renders scalar volumes, extract one channel", samples);
    if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_MINISWHITE)
        bad_file(file.path(), "the pixels are not grey values (TIFF photometric {}): save the stack as greyscale", photometric);
    p.white_is_zero = photometric == PHOTOMETRIC_MINISWHITE;
    p.type = sample_type(file);
    return p;
}

/// Strip or tile extents against the page and the file, so that no page asks for what the file cannot hold.
void check_extents(const TiffFile& file, const Page& page) {
    TIFF* const t = file.get();
    const bool tiled = TIFFIsTiled(t);
    const std::uint64_t pieces = tiled ? TIFFNumberOfTiles(t) : TIFFNumberOfStrips(t), file_bytes = std::filesystem::file_size(file.path());
    const std::uint64_t page_bytes = std::uint64_t{page.width} * page.height * sample_bytes(page.type);
    std::uint64_t stored = 0;
    for (std::uint32_t i = 0; i < pieces; ++i) {
        int error = 0;
        const std::uint64_t bytes = TIFFGetStrileByteCountWithErr(t, i, &error), offset = TIFFGetStrileOffsetWithErr(t, i, &error);
        if (error) file.fail();
        if (offset > file_bytes || bytes > file_bytes - offset)
            bad_file(file.path(), "page {} holds bytes {} to {}, the file has {}: it is truncated", TIFFCurrentDirectory(t), offset,
                     offset + bytes, file_bytes);
        stored += bytes;
    }
    const bool plain = file.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
    // No codec of libtiff packs a page tighter than this; zstd comes nearest.
    constexpr std::uint64_t greatest_ratio = 40000;
    check_capacity(page_bytes, plain ? stored : stored * greatest_ratio, file.path());
}

/// libtiff takes a directory whose link to the next one is cut off for the last: the file must hold the link of the current one.
void check_link(const TiffFile& file) {
    const bool wide = TIFFIsBigTIFF(file.get());
    const std::size_t count_bytes = wide ? 8 : 2, entry_bytes = wide ? 20 : 12, link_bytes = wide ? 8 : 4;
    const std::uint64_t offset = TIFFCurrentDirOffset(file.get()), size = std::filesystem::file_size(file.path());
    std::array<unsigned char, 8> bytes{};
    ByteStream stream(file.path(), ByteStream::Coding::plain, offset);
    std::uint64_t entries = 0;
    if (stream.read(bytes.data(), count_bytes) == count_bytes)
        for (std::size_t i = 0; i < count_bytes; ++i) entries = entries << 8 | bytes[TIFFIsBigEndian(file.get()) ? i : count_bytes - 1 - i];
    const std::uint64_t end = offset + count_bytes + entries * entry_bytes + link_bytes;
    if (end > size)
        bad_file(file.path(), "page {} ends at byte {}, the file has {}: it is truncated", TIFFCurrentDirectory(file.get()), end, size);
}

/// Where the pages are that are slices: not thumbnails. Every page is checked before the first is decoded.
std::vector<toff_t> slices_of(const TiffFile& file, const Page& first) {
    std::vector<toff_t> pages;
    do {
        if (file.field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0) & FILETYPE_REDUCEDIMAGE) continue;
        if (const Page p = page_of(file); !(p == first))
            bad_file(file.path(), "page {} is {} x {} {}, the first is {} x {} {}: all slices must be alike",
                     TIFFCurrentDirectory(file.get()), p.width, p.height, sample_type_name(p.type), first.width, first.height,
                     sample_type_name(first.type));
        check_extents(file, first);
        check_link(file);
        pages.push_back(TIFFCurrentDirOffset(file.get()));
    } while (TIFFReadDirectory(file.get()));
    if (!file.complaint().empty()) file.fail();
    if (pages.empty()) bad_file(file.path(), "the file has no page that is a slice");
    return pages;
}

/// Decodes the current page to `to`: width x height samples in host byte order.
void decode_page(const TiffFile& file, const Page& page, unsigned char* to) {
    TIFF* const t = file.get();
    const std::size_t size = sample_bytes(page.type), row_bytes = page.width * size;
    if (!TIFFIsTiled(t)) {
        const std::uint64_t rows = std::min(file.field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, page.height), page.height);
        for (std::uint32_t strip = 0, n = TIFFNumberOfStrips(t); strip < n; ++strip) {
            const std::uint64_t first = strip * rows;
            if (first >= page.height) break;
            const auto bytes = static_cast<tmsize_t>(std::min(rows, page.height - first) * row_bytes);
            if (TIFFReadEncodedStrip(t, strip, to + first * row_bytes, bytes) != bytes) file.fail();
        }
        return;
    }
    const auto tile_width = file.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0), tile_height = file.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
    if (tile_width == 0 || tile_height == 0) bad_file(file.path(), "its tiles have no size");
    check_capacity(std::uint64_t{tile_width} * tile_height, std::uint64_t{1} << 28, file.path());
    std::vector<unsigned char> tile(std::size_t{tile_width} * tile_height * size);
    if (TIFFTileSize(t) != static_cast<tmsize_t>(tile.size())) file.fail();
    for (std::uint64_t y = 0; y < page.height; y += tile_height) {
        for (std::uint64_t x = 0; x < page.width; x += tile_width) {
            const auto index = TIFFComputeTile(t, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
            if (TIFFReadEncodedTile(t, index, tile.data(), static_cast<tmsize_t>(tile.size())) != static_cast<tmsize_t>(tile.size()))
                file.fail();
            const std::size_t columns = std::min<std::uint64_t>(tile_width, page.width - x),
                              rows = std::min<std::uint64_t>(tile_height, page.height - y);
            for (std::size_t row = 0; row < rows; ++row)
                std::memcpy(to + ((y + row) * page.width + x) * size, tile.data() + row * tile_width * size, columns * size);
        }
    }
}

/// What ImageJ writes into the description of the first page: a line "name=value" each.
std::map<std::string, std::string> imagej_fields(const TiffFile& file) {
    const char* text = nullptr;
    if (!TIFFGetField(file.get(), TIFFTAG_IMAGEDESCRIPTION, &text) || !text || std::strncmp(text, "ImageJ=", 7) != 0) return {};
    std::map<std::string, std::string> fields;
    std::string line;
    for (const char* c = text;; ++c) {
        if (*c != '\n' && *c != '\0') {
            line += *c;
            continue;
        }
        if (const auto equals = line.find('='); equals != std::string::npos) fields[line.substr(0, equals)] = line.substr(equals + 1);
        line.clear();
        if (*c == '\0') return fields;
    }
}

double number_of(const std::map<std::string, std::string>& fields, const char* name, double fallback) {
    const auto f = fields.find(name);
    double value = fallback;
    if (f != fields.end()) std::from_chars(f->second.data(), f->second.data() + f->second.size(), value);
    return value;
}

/// ImageJ's calibration; the resolution tags of other programs mean print, not specimens, and are not taken.
std::optional<Double3> imagej_spacing(const TiffFile& file, const std::map<std::string, std::string>& fields) {
    static const std::map<std::string, double> units_mm{{"mm", 1},           {"millimeter", 1}, {"cm", 10},        {"inch", 25.4},
                                                        {"um", 1e-3},        {"micron", 1e-3},  {"microns", 1e-3}, {"\\u00B5m", 1e-3},
                                                        {"\xc2\xb5m", 1e-3}, {"\xb5m", 1e-3},   {"nm", 1e-6}};
    const auto unit = fields.find("unit");
    const auto mm = unit == fields.end() ? units_mm.end() : units_mm.find(unit->second);
    float x = 0, y = 0;
    if (mm == units_mm.end() || !TIFFGetField(file.get(), TIFFTAG_XRESOLUTION, &x) || !TIFFGetField(file.get(), TIFFTAG_YRESOLUTION, &y) ||
        !(x > 0) || !(y > 0))
        return std::nullopt;
    return Double3{mm->second / double{x}, mm->second / double{y}, mm->second * std::abs(number_of(fields, "spacing", 1))};
}

} // namespace

Voxels read_tiff(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options) {
    TiffFile head(files.front());
    const Page page = page_of(head);
    const auto imagej = imagej_fields(head);
    const auto calibration = imagej_spacing(head, imagej);
    std::vector<toff_t> pages = slices_of(head, page);
    const bool folder = files.size() > 1;

    std::vector<std::string> notes;
    std::int64_t frames = 1;
    if (!folder) {
        const double channels = number_of(imagej, "channels", 1), planes = number_of(imagej, "slices", 1) * number_of(imagej, "frames", 1);
        if (channels > 1 && planes > 1)
            bad_file(path, "the stack has {:g} channels: clvr renders scalar volumes, split the channels in ImageJ", channels);
        if (channels > 1) notes.push_back("the file calls its pages channels: taken as slices"); // as writers other than ImageJ do
        if (number_of(imagej, "images", 1) > static_cast<double>(pages.size()) && pages.size() == 1)
            bad_file(path, "ImageJ says {} slices but the file has one page (its form for stacks above 4 GB): save it as BigTIFF",
                     imagej.at("images"));
        if (const double f = number_of(imagej, "frames", 1);
            f > 1 && f <= static_cast<double>(pages.size()) && pages.size() % static_cast<std::size_t>(f) == 0)
            frames = static_cast<std::int64_t>(f);
    }
    check_frame(options.frame, frames, path);
    const std::size_t slices = folder ? files.size() : pages.size() / static_cast<std::size_t>(frames);
    pages.erase(pages.begin(), pages.begin() + static_cast<std::ptrdiff_t>(folder ? 0 : slices * static_cast<std::size_t>(options.frame)));

    Voxels v;
    describe(v, path, folder ? "TIFF slices" : "TIFF", page.type);
    v.notes.insert(v.notes.end(), notes.begin(), notes.end());
    v.dims = check_dims({page.width, page.height, static_cast<std::int64_t>(slices)}, 1, page.type, path).dims;
    v.geometry.spacing = options.spacing ? *options.spacing : calibration.value_or(Double3{1, 1, 1});
    check_geometry(v.geometry, path);
    if (!options.spacing && !calibration) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed (--spacing sets it)");
    if (page.white_is_zero) v.notes.push_back("the file shows its smallest values as white: values are taken as stored");

    const std::size_t page_samples = std::size_t{page.width} * page.height, slice_bytes = page_samples * sample_bytes(page.type);
    allocate(v);
    std::vector<unsigned char> scratch(is_kept(page.type) ? 0 : slice_bytes);
    const auto decode = [&](const TiffFile& file, toff_t at, std::size_t slice) {
        if (!TIFFSetSubDirectory(file.get(), at)) file.fail();
        decode_page(file, page, scratch.empty() ? v.bytes.data() + slice * slice_bytes : scratch.data());
        if (!scratch.empty()) store_samples(scratch.data(), page.type, page_samples, v, slice * page_samples);
    };
    for (std::size_t slice = 0; slice < slices; ++slice) {
        if (!folder) {
            decode(head, pages[slice], slice);
            continue;
        }
        const TiffFile file(files[slice]);
        const auto own = slices_of(file, page);
        if (own.size() > 1)
            bad_file(files[slice], "it has {} pages although it stands in a folder of slices: name this file alone", own.size());
        decode(file, own.front(), slice);
    }
    return v;
}

} // namespace clvr
