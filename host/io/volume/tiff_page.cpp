#include "host/io/volume/tiff_page.hpp"
#include "host/io/volume/tiff_depth.hpp"
#include "host/io/volume/tiff_samples.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <tiffio.h>
#include <tuple>

namespace clvr {

namespace {

// No codec of libtiff packs a page tighter than this; zstd comes nearest.
constexpr std::uint64_t tiff_ratio = 40000;

/// Codecs that occur in TIFF files; libtiff has only some of them.
std::string codec_name(std::uint16_t compression) {
    static const std::map<std::uint16_t, const char*> names{
        {6, "old-style JPEG"},  {9, "JBIG T.85"},     {10, "JBIG T.43"},     {22610, "JPEG XR"},
        {32809, "ThunderScan"}, {33003, "JPEG 2000"}, {33004, "JPEG 2000"},  {33005, "JPEG 2000"},
        {33007, "Aperio JPEG"}, {34661, "JBIG"},      {34676, "SGI LogLuv"}, {34677, "SGI LogLuv24"},
        {34712, "JPEG 2000"},   {34887, "LERC"},      {34892, "lossy JPEG"}, {34925, "LZMA"},
        {34933, "PNG"},         {34934, "JPEG XR"},   {48124, "JetRaw"},     {50000, "Zstandard"},
        {50001, "WebP"},        {50002, "JPEG XL"},   {52546, "JPEG XL"},    {65000, "EER"},
        {65001, "EER"},         {65002, "EER"},       {32908, "PixarFilm"},  {32909, "PixarLog"},
        {32946, "deflate"},     {8, "deflate"},       {7, "JPEG"},           {5, "LZW"},
        {32773, "PackBits"}};
    const auto name = names.find(compression);
    return name == names.end() ? std::to_string(compression) : fmt::format("{} ({})", name->second, compression);
}

void check_codec(const TiffFile& file, std::uint16_t bits, std::uint16_t sample_format) {
    const auto compression = file.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (!TIFFIsCODECConfigured(compression) || compression == COMPRESSION_SGILOG || compression == COMPRESSION_SGILOG24)
        bad_file(file.path(), "compression {} is not supported: save it without compression, or as deflate or LZW",
                 codec_name(compression));
    if (compression == COMPRESSION_NONE) return;
    const auto predictor = file.field<std::uint16_t>(TIFFTAG_PREDICTOR, PREDICTOR_NONE);
    const bool whole = bits == 8 || bits == 16 || bits == 32 || bits == 64;
    if ((predictor == PREDICTOR_HORIZONTAL && !whole) || (predictor == PREDICTOR_FLOATINGPOINT && sample_format != SAMPLEFORMAT_IEEEFP) ||
        predictor > PREDICTOR_FLOATINGPOINT)
        bad_file(file.path(), "predictor {} with {} bits is not supported: save it without a predictor", predictor, bits);
}

/// Whether a colour table gives each value a grey that rises (or falls) with it: then the values themselves are data.
bool is_grey_ramp(const TiffFile& file, std::uint16_t bits) {
    std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
    if (bits > 16 || !TIFFGetField(file.get(), TIFFTAG_COLORMAP, &red, &green, &blue)) return false;
    const std::size_t n = std::size_t{1} << bits;
    const bool falls = red[0] > red[n - 1];
    for (std::size_t i = 0; i < n; ++i) {
        const long even = static_cast<long>(65535 * (falls ? n - 1 - i : i) / std::max<std::size_t>(n - 1, 1));
        if (red[i] != green[i] || red[i] != blue[i] || std::abs(long{red[i]} - even) > 256) return false;
    }
    return true;
}

void check_photometric(const TiffFile& file, const TiffForm& form, bool one_of_colour, bool indexed) {
    switch (form.photometric) {
    case PHOTOMETRIC_MINISBLACK:
    case PHOTOMETRIC_MINISWHITE:
        return;
    case PHOTOMETRIC_RGB:
        if (one_of_colour) return;
        bad_file(file.path(), "the pixels have {} channels (colour): clvr renders scalar volumes, choose one by --channel N", form.samples);
    case PHOTOMETRIC_PALETTE:
        if (indexed || is_grey_ramp(file, form.bits)) return;
        bad_file(file.path(), "the pixels are numbers of colours in a table: save the stack as greyscale");
    default:
        bad_file(file.path(), "the pixels are not grey values (TIFF photometric {}): save the stack as greyscale", form.photometric);
    }
}

/// Pieces of the current page that stand beside each other: strips have the page's width.
struct Pieces {
    bool tiled = false;
    std::uint32_t width = 0, height = 0;
};
Pieces pieces_of(const TiffFile& file, const TiffForm& form) {
    Pieces p{TIFFIsTiled(file.get()) != 0, form.width, form.height};
    if (!p.tiled) {
        p.height = std::min(file.field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, form.height), form.height);
        if (p.height == 0) bad_file(file.path(), "its strips have no rows");
        return p;
    }
    p.width = file.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0), p.height = file.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
    if (p.width == 0 || p.height == 0) bad_file(file.path(), "its tiles have no size");
    check_capacity(std::uint64_t{p.width} * p.height, std::uint64_t{1} << 28, file.path());
    return p;
}

void decode_strips(const TiffFile& file, const TiffForm& form, std::uint16_t sample, unsigned char* to) {
    const Pieces pieces = pieces_of(file, form);
    const std::uint64_t row_bytes = form.row_bytes(form.width), size = sample_bytes(form.type);
    const std::uint32_t strips = (form.height + pieces.height - 1) / pieces.height;
    const bool direct = is_stored_as(form);
    std::vector<unsigned char> scratch(direct ? 0 : pieces.height * row_bytes);
    for (std::uint32_t strip = 0; strip < strips; ++strip) {
        const std::uint64_t first = std::uint64_t{strip} * pieces.height,
                            rows = std::min<std::uint64_t>(pieces.height, form.height - first);
        unsigned char* const out = to + first * form.width * size;
        const auto bytes = static_cast<tmsize_t>(rows * row_bytes);
        const std::uint32_t index = strip + (form.separate ? sample * strips : 0);
        if (TIFFReadEncodedStrip(file.get(), index, direct ? out : scratch.data(), bytes) != bytes) file.fail();
        if (!direct)
            for (std::uint64_t row = 0; row < rows; ++row)
                unpack_samples(scratch.data() + row * row_bytes, form, sample, form.width, out + row * form.width * size);
    }
}

void decode_tiles(const TiffFile& file, const TiffForm& form, std::uint16_t sample, unsigned char* to) {
    const Pieces tile = pieces_of(file, form);
    const std::uint64_t row_bytes = form.row_bytes(tile.width), size = sample_bytes(form.type), tile_bytes = row_bytes * tile.height;
    check_capacity(tile_bytes, file.size() * tiff_ratio, file.path());
    const auto whole = static_cast<tmsize_t>(tile_bytes);
    if (TIFFTileSize(file.get()) != whole) file.fail();
    std::vector<unsigned char> stored(tile_bytes);
    for (std::uint32_t z = 0; z < form.depth; ++z)
        for (std::uint64_t y = 0; y < form.height; y += tile.height)
            for (std::uint64_t x = 0; x < form.width; x += tile.width) {
                const auto index = TIFFComputeTile(file.get(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), z, sample);
                if (TIFFReadEncodedTile(file.get(), index, stored.data(), whole) != whole) file.fail();
                const std::uint64_t columns = std::min<std::uint64_t>(tile.width, form.width - x),
                                    rows = std::min<std::uint64_t>(tile.height, form.height - y);
                for (std::uint64_t row = 0; row < rows; ++row)
                    unpack_samples(stored.data() + row * row_bytes, form, sample, columns,
                                   to + ((std::uint64_t{z} * form.height + y + row) * form.width + x) * size);
            }
}

} // namespace

bool TiffForm::is_alike(const TiffForm& o) const {
    return std::tie(width, height, depth, bits, sample_format, samples, photometric, type) ==
           std::tie(o.width, o.height, o.depth, o.bits, o.sample_format, o.samples, o.photometric, o.type);
}

std::string form_text(const TiffForm& f) {
    std::string text = fmt::format("{} x {} {}", f.width, f.height, sample_type_name(f.type));
    if (f.depth != 1) text = fmt::format("{} x {} x {} {}", f.width, f.height, f.depth, sample_type_name(f.type));
    if (f.bits != 8 * sample_bytes(f.type)) text += fmt::format(" of {} bits", f.bits);
    if (f.samples != 1) text += fmt::format(" of {} channels", f.samples);
    return f.photometric == PHOTOMETRIC_MINISWHITE ? text + " (white is zero)" : text;
}

TiffForm form_of(const TiffFile& file, bool one_of_colour, bool indexed) {
    TiffForm f;
    if (!TIFFGetField(file.get(), TIFFTAG_IMAGEWIDTH, &f.width) || !TIFFGetField(file.get(), TIFFTAG_IMAGELENGTH, &f.height) ||
        f.width == 0 || f.height == 0)
        bad_file(file.path(), "a page has no size");
    f.depth = std::max(file.field<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1), std::uint32_t{1});
    f.bits = file.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    f.sample_format = file.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    f.samples = std::max(file.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1), std::uint16_t{1});
    f.separate = f.samples > 1 && file.field<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
    f.photometric = file.field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    const double bits = double{1} * f.width * f.height * f.depth * f.samples * f.bits;
    if (f.depth > 0x7fffffff || bits > 0x1p62) bad_file(file.path(), "the size {} x {} x {} is impossible", f.width, f.height, f.depth);
    check_codec(file, f.bits, f.sample_format);
    check_photometric(file, f, one_of_colour, indexed);
    const auto type = decoded_type(f.bits, f.sample_format);
    if (!type)
        bad_file(
            file.path(),
            "pixels of {} bits in TIFF sample format {} are not read: expected integers of 1 to 32 or 64 bits, or floats of 16, 24, 32 "
            "or 64 bits",
            f.bits, f.sample_format);
    f.type = *type;
    return f;
}

void check_extents(const TiffFile& file, const TiffForm& form) {
    TIFF* const t = file.get();
    file.check_counts();
    const Pieces piece = pieces_of(file, form);
    if (has_deep_blocks(file, form)) { // they are checked one by one
        check_capacity(form.pixels() * sample_bytes(form.type), file.size() * 1032, file.path());
        return;
    }
    const std::uint64_t pieces = piece.tiled ? TIFFNumberOfTiles(t) : TIFFNumberOfStrips(t);
    const std::uint64_t page_bytes = form.row_bytes(form.width) * form.height * form.depth * (form.separate ? form.samples : 1);
    std::uint64_t stored = 0;
    for (std::uint32_t i = 0; i < pieces; ++i) {
        int error = 0;
        const std::uint64_t bytes = TIFFGetStrileByteCountWithErr(t, i, &error), offset = TIFFGetStrileOffsetWithErr(t, i, &error);
        if (error) file.fail();
        if (offset > file.size() || bytes > file.size() - offset)
            bad_file(file.path(), "page {} holds bytes {} to {}, the file has {}: it is truncated", TIFFCurrentDirectory(t), offset,
                     offset + bytes, file.size());
        stored += bytes;
    }
    const bool plain = file.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
    check_capacity(page_bytes, plain ? stored : stored * tiff_ratio, file.path());
}

void decode_page(const TiffFile& file, const TiffForm& form, std::uint16_t sample, unsigned char* to) {
    if (has_deep_blocks(file, form))
        decode_deep_blocks(file, form, to);
    else if (TIFFIsTiled(file.get()))
        decode_tiles(file, form, sample, to);
    else
        decode_strips(file, form, sample, to);
}

bool is_plain(const TiffFile& file, const TiffForm& form) {
    TIFF* const t = file.get();
    if (TIFFIsTiled(t) || form.samples != 1 || !is_stored_as(form) ||
        file.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) != COMPRESSION_NONE)
        return false;
    for (std::uint32_t i = 1, n = TIFFNumberOfStrips(t); i < n; ++i)
        if (TIFFGetStrileOffset(t, i) != TIFFGetStrileOffset(t, i - 1) + TIFFGetStrileByteCount(t, i - 1)) return false;
    return true;
}

void decode_plain(const TiffFile& file, const TiffForm& form, std::uint64_t offset, unsigned char* to) {
    ByteStream stream(file.path(), ByteStream::Coding::plain, offset);
    const std::size_t n = std::size_t{form.width} * form.height, bytes = n * sample_bytes(form.type);
    if (stream.read(to, bytes) != bytes)
        bad_file(file.path(), "expected {} bytes of pixels from byte {} on, the file has {}: it is truncated", bytes, offset, file.size());
    if (must_swap(file.is_big_endian())) swap_samples(to, form.type, n);
}

std::vector<std::string> form_notes(const TiffFile& file, const TiffForm& form) {
    static const std::map<std::uint16_t, const char*> corners{{2, "top right"}, {3, "bottom right"}, {4, "bottom left"}, {5, "left top"},
                                                              {6, "right top"}, {7, "right bottom"}, {8, "left bottom"}};
    std::vector<std::string> notes;
    if (form.photometric == PHOTOMETRIC_MINISWHITE)
        notes.push_back("the file shows its smallest values as white: values are taken as stored");
    if (form.photometric == PHOTOMETRIC_PALETTE && !is_grey_ramp(file, form.bits))
        notes.push_back("the file shows its values through a colour table: values are taken as stored");
    const auto corner = corners.find(file.field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT));
    if (corner != corners.end())
        notes.push_back(fmt::format("its orientation tag says that the first pixel is {}: this is not applied, the volume may be mirrored",
                                    corner->second));
    return notes;
}

} // namespace clvr
