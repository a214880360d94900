#include "host/io/volume/tiff_depth.hpp"
#include "host/io/volume/tiff_samples.hpp"

#include <algorithm>
#include <tiffio.h>

namespace clvr {

namespace {

/// Strips or tiles: each `width` x `height` x `depth`, x fastest, with what sticks out of the page.
struct Blocks {
    std::uint64_t width, height, depth;
    bool padded; ///< tiles that reach beyond the page are stored whole, strips end with the page
    TiffEntry offsets, counts;
};

std::uint64_t value_of(const TiffFile& file, const TiffEntry& entry, std::uint64_t i) {
    const std::size_t bytes = entry.type == TIFF_SHORT ? 2 : entry.type == TIFF_LONG8 ? 8 : 4;
    return file.integer(entry.value_at + i * bytes, bytes);
}

Blocks blocks_of(const TiffFile& file, const TiffForm& form) {
    const bool tiled = TIFFIsTiled(file.get()) != 0;
    const auto offsets = file.entry(tiled ? TIFFTAG_TILEOFFSETS : TIFFTAG_STRIPOFFSETS),
               counts = file.entry(tiled ? TIFFTAG_TILEBYTECOUNTS : TIFFTAG_STRIPBYTECOUNTS);
    if (!offsets || !counts || offsets->count != counts->count) bad_file(file.path(), "it does not say where its strips or tiles are");
    Blocks b{form.width, form.height, form.depth, tiled, *offsets, *counts};
    if (tiled) {
        b.width = file.field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0), b.height = file.field<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
        b.depth = std::max(file.field<std::uint32_t>(TIFFTAG_TILEDEPTH, 1), std::uint32_t{1});
        if (b.width == 0 || b.height == 0) bad_file(file.path(), "its tiles have no size");
    } else if (offsets->count > 1) { // one strip may hold all
        b.height = std::min(file.field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, form.height), form.height);
        b.depth = 1;
        if (b.height == 0) bad_file(file.path(), "its strips have no rows");
    }
    return b;
}

/// `bytes` bytes of a block, unpacked.
void read_block(const TiffFile& file, std::uint64_t offset, std::uint64_t stored, bool packed, std::vector<unsigned char>& block) {
    if (offset > file.size() || stored > file.size() - offset)
        bad_file(file.path(), "a strip or tile holds bytes {} to {}, the file has {}: it is truncated", offset, offset + stored,
                 file.size());
    ByteStream stream(file.path(), packed ? ByteStream::Coding::deflated : ByteStream::Coding::plain, offset);
    if ((!packed && stored < block.size()) || stream.read(block.data(), block.size()) != block.size())
        bad_file(file.path(), "a strip or tile has fewer than the {} bytes expected: the file is truncated or damaged", block.size());
}

} // namespace

bool has_deep_blocks(const TiffFile& file, const TiffForm& form) {
    return form.depth > 1 && (!TIFFIsTiled(file.get()) || file.field<std::uint32_t>(TIFFTAG_TILEDEPTH, 1) > 1);
}

void decode_deep_blocks(const TiffFile& file, const TiffForm& form, unsigned char* to) {
    const auto compression = file.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    const bool packed = compression == COMPRESSION_ADOBE_DEFLATE || compression == COMPRESSION_DEFLATE;
    const bool predicted = packed && file.field<std::uint16_t>(TIFFTAG_PREDICTOR, PREDICTOR_NONE) != PREDICTOR_NONE;
    if ((!packed && compression != COMPRESSION_NONE) || predicted || !is_stored_as(form) || form.samples != 1)
        bad_file(file.path(),
                 "its pages hold {} slices each (ImageDepth), packed in a way that clvr does not read: save it with a page for each slice",
                 form.depth);
    const Blocks b = blocks_of(file, form);
    const std::uint64_t size = sample_bytes(form.type), across = (form.width + b.width - 1) / b.width,
                        down = (form.height + b.height - 1) / b.height, deep = (form.depth + b.depth - 1) / b.depth;
    if (b.offsets.count < across * down * deep)
        bad_file(file.path(), "it has {} strips or tiles where {} slices need {}: it is truncated", b.offsets.count, form.depth,
                 across * down * deep);
    constexpr std::uint64_t greatest_ratio = 1032; // of deflate
    check_capacity(b.width * b.height, file.size() * greatest_ratio, file.path());
    check_capacity(b.width * b.height * size * b.depth, file.size() * greatest_ratio, file.path());
    std::vector<unsigned char> block;
    for (std::uint64_t i = 0; i < across * down * deep; ++i) {
        const std::uint64_t x = i % across * b.width, y = i / across % down * b.height, z = i / across / down * b.depth;
        const std::uint64_t columns = std::min(b.width, form.width - x), rows = std::min(b.height, form.height - y),
                            layers = std::min(b.depth, form.depth - z);
        const std::uint64_t block_rows = b.padded ? b.height : rows;
        block.resize(b.width * block_rows * (b.padded ? b.depth : layers) * size);
        read_block(file, value_of(file, b.offsets, i), value_of(file, b.counts, i), packed, block);
        for (std::uint64_t layer = 0; layer < layers; ++layer)
            for (std::uint64_t row = 0; row < rows; ++row)
                std::copy_n(block.data() + (layer * block_rows + row) * b.width * size, columns * size,
                            to + (((z + layer) * form.height + y + row) * form.width + x) * size);
    }
    if (must_swap(file.is_big_endian())) swap_samples(to, form.type, form.pixels());
}

} // namespace clvr
