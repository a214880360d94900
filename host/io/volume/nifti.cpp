// NIfTI files: single ones and pairs, types and axes as in nifti1.h and nifti2.h of the NIfTI-1.1 and NIfTI-2 standards.
#include "host/io/volume/file_pair.hpp"
#include "host/io/volume/format.hpp"
#include "host/io/volume/header_bytes.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/nifti_header.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace clvr {

namespace {

constexpr int intent_label = 1002, intent_rgb = 2003, intent_rgba = 2004;

SampleType sample_type(const NiftiHeader& h, const std::string& path) {
    switch (h.datatype) {
    case 2:
        return SampleType::u8;
    case 4:
        return SampleType::i16;
    case 8:
        return SampleType::i32;
    case 16:
        return SampleType::f32;
    case 64:
        return SampleType::f64;
    case 256:
        return SampleType::i8;
    case 512:
        return SampleType::u16;
    case 768:
        return SampleType::u32;
    case 1024:
        return SampleType::i64;
    case 1280:
        return SampleType::u64;
    case 128:
    case 2304:
        bad_file(path, "the voxels are RGB colours (NIfTI type {}): clvr renders scalar volumes, extract one channel", h.datatype);
    case 32:
    case 1792:
    case 2048:
        bad_file(path, "the voxels are complex numbers (NIfTI type {}): clvr renders scalar volumes, store the magnitude", h.datatype);
    default:
        bad_file(path, "unknown NIfTI data type {}: expected an 8 to 64 bit integer, float or double", h.datatype);
    }
}

/// A path without its last characters: those of `ending`, and of .gz behind it.
std::string without_ending(const std::string& path, const std::string& ending) { return path.substr(0, lower_case(path).rfind(ending)); }

bool has_ending(const std::string& path, const std::string& ending) {
    const std::string name = lower_case(path);
    return ends_with(name, ending) || ends_with(name, ending + ".gz");
}

/// Where a file that was named has its header and its voxels.
struct Files {
    std::string header, voxels;
    NiftiHeader h;
};

/// The bytes decide whether one file holds both; then the names: P.hdr and P.img, upper or lower case, compressed or not, of which the user
/// may name either.
Files files_of(const std::string& path, HeaderRemarks& remarks) {
    Files f;
    f.header = path;
    if (has_ending(path, ".img") && !is_single_nifti(read_head_inside(path, 540))) {
        f.header = file_beside(path, {".img", ".img.gz"}, {".hdr", ".hdr.gz"});
        if (f.header.empty())
            bad_file(path, "not a NIfTI file by itself, and its header is missing: expected {0}.hdr or {0}.hdr.gz",
                     without_ending(path, ".img"));
        f.voxels = path;
    }
    ByteStream stream = open_inside(f.header);
    f.h = read_nifti_header(stream, f.header);
    if (!f.voxels.empty()) {
        if (!f.h.pair)
            remarks.decisions.push_back(
                fmt::format("the header {} calls itself a single file: the voxels are those of the file named", f.header));
        f.h.pair = true;
        return f;
    }
    f.voxels = path;
    if (!f.h.pair) return f;
    f.voxels = file_beside(path, {".hdr", ".hdr.gz"}, {".img", ".img.gz"});
    if (!f.voxels.empty()) return f;
    if (has_ending(path, ".hdr")) bad_file(path, "its voxels are missing: expected {0}.img or {0}.img.gz", without_ending(path, ".hdr"));
    remarks.decisions.push_back("the header says that the voxels are in an .img file: there is none, they are taken from this file");
    f.voxels = path;
    f.h.pair = false;
    return f;
}

/// Whether a file holds so many bytes, decompressed: gzip ends with its size modulo 2^32.
bool holds_exactly(const std::string& path, std::uint64_t bytes) {
    const std::uint64_t size = std::filesystem::file_size(path);
    if (!is_gzip(path)) return size == bytes;
    std::string end(4, '\0');
    return size >= 4 && ByteStream(path, ByteStream::Coding::plain, size - 4).read(end.data(), 4) == 4 &&
           HeaderBytes(end, must_swap(false)).at<std::uint32_t>(0) == static_cast<std::uint32_t>(bytes);
}

/// Where the voxels of `bytes` bytes start. Some writers leave the offset of a single file at 0.
std::uint64_t voxel_offset(const NiftiHeader& h, std::uint64_t bytes, const std::string& path, HeaderRemarks& remarks) {
    const std::uint64_t header_bytes = h.version == 2 ? 540 : 348, usual = header_bytes + 4; // 4: whether extensions follow
    const double given = h.voxel_offset;
    if (given != std::floor(given) || !(std::abs(given) < 1e15) || (h.pair && given < 0))
        bad_file(path, "the voxels start at byte {:g}, expected a whole number of at least {}", given, h.pair ? 0 : usual);
    if (h.pair || given >= static_cast<double>(usual)) return static_cast<std::uint64_t>(given);
    // Right behind the header only where the file ends just so.
    const auto least = std::max(header_bytes, static_cast<std::uint64_t>(std::max(given, 0.0)));
    const std::uint64_t offset = holds_exactly(path, least + bytes) ? least : usual;
    if (static_cast<double>(offset) != given)
        remarks.notes.push_back(
            fmt::format("the header says that the voxels start at byte {:g}: byte {} is taken, behind the header", given, offset));
    return offset;
}

} // namespace

Voxels read_nifti(const std::string& path, const VolumeReadOptions& options) {
    HeaderRemarks remarks;
    const Files files = files_of(path, remarks);
    const NiftiHeader& h = files.h;
    const auto size = nifti_sizes(h, path, remarks);
    if (size[6] > 1 || size[7] > 1)
        bad_file(path, "the file has {} x {} x {} x {} x {} x {} x {} voxels: clvr reads up to 5 axes, extract one volume", size[1],
                 size[2], size[3], size[4], size[5], size[6], size[7]);
    if (h.intent == intent_label) bad_file(path, "the file says that it is a label map: clvr renders measured values, not labels");
    if (h.intent == intent_rgb || h.intent == intent_rgba)
        bad_file(path, "the voxels are RGB colours (NIfTI intent {}): clvr renders scalar volumes, extract one channel", h.intent);

    const SampleType type = sample_type(h, path);
    const CheckedDims dims = check_dims({size[1], size[2], size[3]}, checked_product({size[4], size[5]}, path), type, path);
    check_frame(options.frame, size[4], path);
    const std::int64_t channel = chosen_channel(options, size[5], path, remarks.notes);
    const int frames = say_frame(options.frame, size[4], "axis 4 (time)", remarks.decisions);

    Voxels v;
    describe(v, path, h.version == 2 ? "NIfTI-2" : "NIfTI", type);
    v.dims = dims.dims;
    v.frames = frames;
    v.geometry = nifti_geometry(h, size, path, remarks);
    if (h.slope != 0 && !std::isnan(h.slope)) { // 0 or NaN: the file says "not scaled"
        v.slope = h.slope;
        v.intercept = h.intercept;
    }

    ByteStream stream = open_inside(files.voxels);
    const std::uint64_t offset = voxel_offset(h, dims.bytes, files.voxels, remarks);
    check_capacity(dims.bytes, stream.capacity() - std::min(stream.capacity(), offset), files.voxels);
    stream.skip(offset + dims.frame_bytes * static_cast<std::uint64_t>(options.frame + channel * size[4]));
    read_samples(stream, type, h.swapped, v);
    stream.drain();
    if (stream.position() < offset + dims.bytes)
        bad_file(files.voxels, "expected {} bytes of voxels, found {}: the file is truncated", dims.bytes, stream.position() - offset);
    if (stream.position() > offset + dims.bytes)
        v.notes.push_back(
            fmt::format("{} bytes after the voxels were ignored: is the header right?", stream.position() - offset - dims.bytes));
    v.notes.insert(v.notes.end(), remarks.notes.begin(), remarks.notes.end());
    v.decisions.insert(v.decisions.end(), remarks.decisions.begin(), remarks.decisions.end());
    return v;
}

} // namespace clvr
