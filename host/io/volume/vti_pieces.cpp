#include "host/io/volume/vti_pieces.hpp"
#include "host/io/volume/encodings.hpp"
#include "host/io/volume/text_lines.hpp"

#include <algorithm>
#include <cstring>

namespace clvr {

namespace {

/// The samples of a piece: where its first one lies in the grid, and how many there are.
struct Box {
    std::array<std::size_t, 3> first;
    FileDims dims;
};

Box box_of(const VtiHeader& h, std::size_t piece, bool of_cells) {
    const auto& e = h.extent(piece);
    Box b{};
    VtkGrid points;
    for (std::size_t i = 0; i < 3; ++i) {
        b.first[i] = static_cast<std::size_t>(e[2 * i]);
        points.points[i] = e[2 * i + 1] - e[2 * i] + 1;
    }
    b.dims = points.samples(of_cells);
    return b;
}

/// Fills `part` (dims, type, source set) from one piece.
void read_piece(const VtiHeader& h, std::size_t piece, const VtkArray& array, int time_step, std::int64_t channel, Voxels& part) {
    const VtiValues values = h.values(piece, array, time_step);
    const std::size_t size = sample_bytes(*array.type);
    const auto components = static_cast<std::uint64_t>(array.components);
    const std::uint64_t samples = part.count() * components;
    const bool text = values.format == VtiValues::Format::text, appended = values.format == VtiValues::Format::appended;

    std::unique_ptr<ByteSource> bytes, unpacked, decoded;
    if (appended)
        bytes = std::make_unique<FileBytes>(h.path(), ByteStream::Coding::plain, values.offset);
    else
        bytes = std::make_unique<MemoryBytes>(values.inline_text);
    std::uint64_t capacity = appended ? h.file_size() - std::min(h.file_size(), values.offset) : values.inline_text.size();
    TextLines lines(*bytes, h.path());
    if (text) {
        check_capacity(samples, (capacity + 1) / 2, h.path());
        decoded = std::make_unique<TextSamples>(lines, *array.type, samples, h.path());
    } else {
        const bool base64 = !appended || values.appended_base64;
        if (base64) {
            unpacked = std::make_unique<Base64Bytes>(*bytes);
            capacity = capacity / 4 * 3 + 3;
        }
        decoded = open_vti_values(base64 ? *unpacked : *bytes, h.coding(), samples * size, capacity, h.path());
    }
    PickedBytes picked(*decoded, size, components, static_cast<std::uint64_t>(channel));
    read_samples(components > 1 ? static_cast<ByteSource&>(picked) : *decoded, *array.type, !text && must_swap(h.coding().big_endian),
                 part);
}

void copy_box(const Voxels& part, const Box& box, Voxels& v, std::vector<bool>& filled) {
    const auto width = static_cast<std::size_t>(part.dims[0]), bytes = voxel_bytes(v.type);
    std::size_t from = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.dims[2]); ++k)
        for (std::size_t j = 0; j < static_cast<std::size_t>(part.dims[1]); ++j, from += width) {
            const std::size_t to = box.first[0] + static_cast<std::size_t>(v.dims[0]) *
                                                      (box.first[1] + j + static_cast<std::size_t>(v.dims[1]) * (box.first[2] + k));
            std::memcpy(v.bytes.data() + to * bytes, part.bytes.data() + from * bytes, width * bytes);
            std::fill_n(filled.begin() + static_cast<std::ptrdiff_t>(to), width, true);
        }
}

/// Throws Error{input} unless the whole grid can be in a file of this size: before it is allocated.
void check_grid(const VtiHeader& h, const Voxels& v, const VtkArray& array) {
    const std::uint64_t ratio = h.coding().compressor == VtiCompressor::zlib ? 1032 : h.coding().compressor == VtiCompressor::lz4 ? 255 : 8;
    check_capacity(v.count() * sample_bytes(*array.type) * static_cast<std::uint64_t>(array.components), h.file_size() * ratio, h.path());
}

} // namespace

void read_vti_pieces(const VtiHeader& h, const VtkArray& array, int time_step, std::int64_t channel, Voxels& v) {
    const auto whole = h.grid().samples(array.of_cells);
    if (h.pieces() == 1 && box_of(h, 0, array.of_cells).dims == whole) {
        read_piece(h, 0, array, time_step, channel, v);
        return;
    }
    check_grid(h, v, array);
    allocate(v);
    std::vector<bool> filled(v.count());
    for (std::size_t i = 0; i < h.pieces(); ++i) {
        const Box box = box_of(h, i, array.of_cells);
        Voxels part;
        part.source = v.source;
        part.type = v.type;
        part.dims = check_dims(box.dims, array.components, *array.type, v.source).dims;
        for (std::size_t a = 0; a < 3; ++a) // a flat piece of a grid that is not flat has no cells
            if (box.first[a] + static_cast<std::size_t>(part.dims[a]) > static_cast<std::size_t>(v.dims[a]))
                bad_file(v.source, "piece {} holds no cells", i);
        read_piece(h, i, array, time_step, channel, part);
        copy_box(part, box, v, filled);
    }
    if (const auto empty = std::count(filled.begin(), filled.end(), false); empty > 0)
        bad_file(v.source, "its {} pieces leave {} of {} voxels of the whole extent without a value", h.pieces(), empty, v.count());
}

} // namespace clvr
