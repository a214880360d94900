// FreeSurfer's MGH and MGZ (surfer.nmr.mgh.harvard.edu, "MghFormat"): big-endian, 284 bytes of header.
#include "host/io/volume/header_bytes.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/samples.hpp"

namespace clvr {

namespace {

constexpr std::size_t mgh_header_bytes = 284;

SampleType sample_type(int type, const std::string& path) {
    switch (type) {
    case 0:
        return SampleType::u8;
    case 1:
        return SampleType::i32;
    case 3:
        return SampleType::f32;
    case 4:
        return SampleType::i16;
    case 10:
        return SampleType::u16;
    default:
        bad_file(path, "its MGH type {} is not read: expected 0 (uchar), 1 (int), 3 (float), 4 (short) or 10 (ushort)", type);
    }
}

/// Index to world: the header gives the RAS position of index dims / 2. Without it, FreeSurfer takes a coronal volume around 0.
Geometry geometry(const HeaderBytes& h, const Int3& dims, Voxels& v) {
    Geometry g;
    Matrix3 ras{{{{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}};
    Double3 centre{0, 0, 0};
    if (h.at<std::int16_t>(28) != 0) {
        for (int j = 0; j < 3; ++j) {
            const auto axis = static_cast<std::size_t>(j);
            g.spacing[j] = h.at<float>(30 + 4 * axis);
            centre[j] = h.at<float>(78 + 4 * axis);
            for (int i = 0; i < 3; ++i) ras.row[i][j] = h.at<float>(42 + 12 * axis + 4 * static_cast<std::size_t>(i));
        }
    } else {
        v.notes.push_back("the file gives no geometry (goodRASFlag 0): FreeSurfer's own is taken, coronal with 1 mm around the origin");
    }
    const Double3 to_lps{-1, -1, 1};
    for (int i = 0; i < 3; ++i) {
        g.origin[i] = centre[i];
        for (int j = 0; j < 3; ++j) {
            g.origin[i] -= ras.row[i][j] * g.spacing[j] * dims[j] / 2.0;
            g.direction.row[i][j] = to_lps[i] * ras.row[i][j];
        }
        g.origin[i] *= to_lps[i];
    }
    for (int j = 0; j < 3; ++j) { // columns of length 1, as six digits leave them
        const double length = norm(g.direction.column(j));
        g.spacing[j] *= length;
        for (auto& row : g.direction.row) row[j] /= length;
    }
    return g;
}

} // namespace

Voxels read_mgh(const std::string& path, const VolumeReadOptions& options) {
    ByteStream stream = open_inside(path);
    std::string bytes(mgh_header_bytes, '\0');
    if (const std::size_t got = stream.read(bytes.data(), mgh_header_bytes); got < mgh_header_bytes)
        bad_file(path, "expected an MGH header of {} bytes, found {}: the file is truncated", mgh_header_bytes, got);
    const HeaderBytes h(bytes, must_swap(true));
    if (const int version = h.at<std::int32_t>(0); version != 1) bad_file(path, "not an MGH file: its version is {}, expected 1", version);
    const auto size = [&](std::size_t i) { return std::int64_t{h.at<std::int32_t>(4 + 4 * i)}; };
    const SampleType type = sample_type(h.at<std::int32_t>(20), path);
    const CheckedDims dims = check_dims({size(0), size(1), size(2)}, size(3), type, path);
    check_frame(options.frame, size(3), path);

    Voxels v;
    describe(v, path, "MGH", type);
    v.dims = dims.dims;
    v.geometry = geometry(h, v.dims, v);
    check_geometry(v.geometry, path);
    v.frames = say_frame(options.frame, size(3), "the fourth axis", v.decisions);
    check_capacity(dims.bytes, stream.capacity() - mgh_header_bytes, path);
    stream.skip(dims.frame_bytes * static_cast<std::uint64_t>(options.frame));
    read_samples(stream, type, must_swap(true), v);
    stream.drain(); // behind the voxels stand scan parameters and tags
    if (stream.position() < mgh_header_bytes + dims.bytes)
        bad_file(path, "expected {} bytes of voxels, found {}: the file is truncated", dims.bytes, stream.position() - mgh_header_bytes);
    return v;
}

} // namespace clvr
