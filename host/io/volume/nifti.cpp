// NIfTI-1 and NIfTI-2: header layout, data types, orientation methods and units as in nifti1.h and nifti2.h of the NIfTI-1.1 and NIfTI-2
// standards.
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace clvr {

namespace {

constexpr int nifti1_bytes = 348, nifti2_bytes = 540;
constexpr int intent_label = 1002;

/// What both header versions say, in one form.
struct NiftiHeader {
    int version = 1;
    bool swapped = false;
    bool pair = false; ///< header and voxels in two files
    std::array<std::int64_t, 8> dim{};
    std::array<double, 8> pixdim{};
    int datatype = 0, intent = 0, units = 0, qform = 0, sform = 0;
    double voxel_offset = 0, slope = 0, intercept = 0;
    std::array<double, 3> quatern{}, qoffset{};
    std::array<std::array<double, 4>, 3> srow{};
};

class Fields {
public:
    Fields(const unsigned char* bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}
    template <class T>
    T at(std::size_t offset) const {
        std::array<unsigned char, sizeof(T)> raw;
        std::copy_n(bytes_ + offset, sizeof(T), raw.begin());
        if (swapped_) std::reverse(raw.begin(), raw.end());
        T value;
        std::memcpy(&value, raw.data(), sizeof(T));
        return value;
    }

private:
    const unsigned char* bytes_;
    bool swapped_;
};

/// Both versions hold the same fields with other types at other places: dims and pixdim, then the rest.
template <class Dim, class Real, class Code>
NiftiHeader parse(const Fields& f, std::size_t dim, std::size_t pixdim, std::size_t scale, std::size_t qform, std::size_t quatern) {
    NiftiHeader h;
    for (std::size_t i = 0; i < 8; ++i) {
        h.dim[i] = f.at<Dim>(dim + i * sizeof(Dim));
        h.pixdim[i] = f.at<Real>(pixdim + i * sizeof(Real));
    }
    h.slope = f.at<Real>(scale);
    h.intercept = f.at<Real>(scale + sizeof(Real));
    h.qform = f.at<Code>(qform);
    h.sform = f.at<Code>(qform + sizeof(Code));
    for (std::size_t i = 0; i < 3; ++i) {
        h.quatern[i] = f.at<Real>(quatern + i * sizeof(Real));
        h.qoffset[i] = f.at<Real>(quatern + (3 + i) * sizeof(Real));
        for (std::size_t j = 0; j < 4; ++j) h.srow[i][j] = f.at<Real>(quatern + (6 + 4 * i + j) * sizeof(Real));
    }
    return h;
}

NiftiHeader read_header(ByteStream& stream, const std::string& path) {
    std::array<unsigned char, nifti2_bytes> bytes{};
    std::size_t got = stream.read(bytes.data(), nifti1_bytes);
    if (got < nifti1_bytes) bad_file(path, "expected a NIfTI header of {} bytes, found {}: the file is truncated", nifti1_bytes, got);
    const auto size = Fields(bytes.data(), false).at<std::int32_t>(0), swapped_size = Fields(bytes.data(), true).at<std::int32_t>(0);
    const bool swapped = swapped_size == nifti1_bytes || swapped_size == nifti2_bytes;
    const int version = (swapped ? swapped_size : size) == nifti2_bytes ? 2 : 1;
    const Fields f(bytes.data(), swapped);
    if (!swapped && size != nifti1_bytes && size != nifti2_bytes)
        bad_file(path, "not a NIfTI file: its first number is {}, expected {} or {}", size, nifti1_bytes, nifti2_bytes);

    const char* magic = reinterpret_cast<const char*>(bytes.data()) + (version == 2 ? 4 : 344);
    const std::string single = version == 2 ? "n+2" : "n+1", pair = version == 2 ? "ni2" : "ni1";
    if (magic != single && magic != pair)
        bad_file(path, "the NIfTI mark \"{}\" or \"{}\" is missing (ANALYZE 7.5 files have no orientation: convert them to NIfTI)", single,
                 pair);
    NiftiHeader h;
    if (version == 2) {
        got += stream.read(bytes.data() + nifti1_bytes, nifti2_bytes - nifti1_bytes);
        if (got < nifti2_bytes) bad_file(path, "expected a NIfTI-2 header of {} bytes, found {}: the file is truncated", nifti2_bytes, got);
        h = parse<std::int64_t, double, std::int32_t>(f, 16, 104, 176, 344, 352);
        h.datatype = f.at<std::int16_t>(12);
        h.voxel_offset = static_cast<double>(f.at<std::int64_t>(168));
        h.units = f.at<std::int32_t>(500);
        h.intent = f.at<std::int32_t>(504);
    } else {
        h = parse<std::int16_t, float, std::int16_t>(f, 40, 76, 112, 252, 256);
        h.datatype = f.at<std::int16_t>(70);
        h.voxel_offset = f.at<float>(108);
        h.units = f.at<std::uint8_t>(123);
        h.intent = f.at<std::int16_t>(68);
    }
    h.version = version;
    h.swapped = swapped;
    h.pair = magic == pair;
    return h;
}

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

double millimetres(int units, const std::string& path) {
    switch (units & 7) { // the low three bits are the unit of space
    case 0:
    case 2:
        return 1;
    case 1:
        return 1000;
    case 3:
        return 1e-3;
    default:
        bad_file(path, "unknown unit of space {}: expected metres (1), millimetres (2) or micrometres (3)", units & 7);
    }
}

/// Columns of index-to-world in RAS, by sform, else qform, else the sizes alone ("method 1").
Matrix3 axes_ras(const NiftiHeader& h, const Double3& spacing, Double3& origin, const std::string& path) {
    Matrix3 m;
    if (h.sform > 0) {
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) m.row[i][j] = h.srow[i][j];
            origin[i] = h.srow[i][3];
        }
        return m;
    }
    if (h.qform > 0) {
        const auto [b, c, d] = h.quatern;
        const double rest = 1 - (b * b + c * c + d * d);
        if (!(rest > -1e-5)) bad_file(path, "the orientation quaternion {:g} {:g} {:g} is longer than 1", b, c, d);
        const double a = std::sqrt(std::max(rest, 0.0));
        m.row = {{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                  {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                  {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}}};
        const double handed = h.pixdim[0] < 0 ? -1 : 1;
        for (auto& row : m.row) row = {row[0] * spacing[0], row[1] * spacing[1], row[2] * spacing[2] * handed};
        origin = h.qoffset;
        return m;
    }
    for (int i = 0; i < 3; ++i) m.row[i][i] = spacing[i];
    origin = {0, 0, 0};
    return m;
}

Geometry geometry(const NiftiHeader& h, const std::string& path) {
    Double3 spacing{1, 1, 1};
    for (int i = 0; i < 3 && i < h.dim[0]; ++i) {
        spacing[i] = std::abs(h.pixdim[i + 1]);
        if (!(spacing[i] > 0) || !std::isfinite(spacing[i]))
            bad_file(path, "the voxel size {:g} x {:g} x {:g} (pixdim) is not usable: each must be finite and not 0", h.pixdim[1],
                     h.pixdim[2], h.pixdim[3]);
    }
    const double scale = millimetres(h.units, path);
    Double3 origin;
    Matrix3 axes = axes_ras(h, spacing, origin, path);
    Geometry g;
    const Double3 to_lps{-1, -1, 1};
    for (int i = 0; i < 3; ++i) {
        g.origin[i] = to_lps[i] * origin[i] * scale;
        for (int j = 0; j < 3; ++j) axes.row[i][j] *= to_lps[i] * scale;
    }
    for (int j = 0; j < 3; ++j) {
        g.spacing[j] = norm(axes.column(j));
        for (int i = 0; i < 3; ++i) g.direction.row[i][j] = axes.row[i][j] / g.spacing[j];
    }
    return g;
}

/// The voxels of a pair: the same name with .img for .hdr, compressed or not.
std::string image_of_pair(const std::string& header) {
    const auto dot = header.rfind(".hdr");
    if (dot == std::string::npos)
        bad_file(header, "the header says that the voxels are in an .img file, but its own name does not end in .hdr");
    const std::string base = header.substr(0, dot) + ".img";
    for (const std::string& name : {base, base + ".gz"})
        if (std::filesystem::is_regular_file(name)) return name;
    bad_file(header, "its voxels are missing: expected {} or {}.gz", base, base);
}

} // namespace

Voxels read_nifti(const std::string& path, const VolumeReadOptions& options) {
    std::string header_path = path;
    if (const auto dot = path.rfind(".img"); dot != std::string::npos) { // named by its voxels: the header is beside
        header_path = path.substr(0, dot) + ".hdr";
        if (!std::filesystem::is_regular_file(header_path)) header_path += ".gz";
    }
    const auto coding = [](const std::string& file) { return is_gzip(file) ? ByteStream::Coding::deflated : ByteStream::Coding::plain; };
    ByteStream header_stream(header_path, coding(header_path));
    const NiftiHeader h = read_header(header_stream, header_path);

    if (h.dim[0] < 1 || h.dim[0] > 7) bad_file(path, "the header says {} dimensions, expected 1 to 7", h.dim[0]);
    const auto size = [&](std::size_t axis) { return static_cast<std::int64_t>(axis) <= h.dim[0] ? h.dim[axis] : 1; };
    if (size(5) > 1)
        bad_file(path, "each voxel has {} values (a vector or tensor): clvr renders scalar volumes, extract one component", size(5));
    if (size(6) > 1 || size(7) > 1) bad_file(path, "the file has more than 4 dimensions: extract one volume");
    if (h.intent == intent_label) bad_file(path, "the file says that it is a label map: clvr renders measured values, not labels");

    const SampleType type = sample_type(h, path);
    const CheckedDims dims = check_dims({size(1), size(2), size(3)}, size(4), type, path);
    check_frame(options.frame, size(4), path);

    Voxels v;
    describe(v, path, h.version == 2 ? "NIfTI-2" : "NIfTI", type);
    v.dims = dims.dims;
    v.geometry = geometry(h, path);
    check_geometry(v.geometry, path);
    if (h.slope != 0 && !std::isnan(h.slope)) { // 0 or NaN: the file says "not scaled"
        v.slope = h.slope;
        v.intercept = h.intercept;
    }

    const std::string voxel_path = h.pair ? image_of_pair(header_path) : path;
    ByteStream stream(voxel_path, coding(voxel_path));
    const double least_offset = h.pair ? 0 : nifti1_bytes;
    if (!(h.voxel_offset >= least_offset) || h.voxel_offset != std::floor(h.voxel_offset) || h.voxel_offset > 1e15)
        bad_file(path, "the voxels start at byte {:g}, expected a whole number of at least {:g}", h.voxel_offset, least_offset);
    const auto offset = static_cast<std::uint64_t>(h.voxel_offset);
    check_capacity(dims.bytes, stream.capacity() - std::min(stream.capacity(), offset), voxel_path);
    stream.skip(offset + dims.frame_bytes * static_cast<std::uint64_t>(options.frame));
    read_samples(stream, type, h.swapped, v);
    stream.drain();
    if (stream.position() < offset + dims.bytes)
        bad_file(voxel_path, "expected {} bytes of voxels, found {}: the file is truncated", dims.bytes, stream.position() - offset);
    if (stream.position() > offset + dims.bytes)
        v.notes.push_back(
            fmt::format("{} bytes after the voxels were ignored: is the header right?", stream.position() - offset - dims.bytes));
    return v;
}

} // namespace clvr
