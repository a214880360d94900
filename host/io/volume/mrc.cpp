// MRC and CCP4 maps of electron microscopy and crystallography (MRC2014: Cheng et al., J. Struct. Biol. 192, 2015, and
// ccpem.ac.uk/mrc_format; IMOD's flags: bio3d.colorado.edu/imod/doc/mrc_format.txt). Lengths are angstroms.
#include "host/io/volume/mrc.hpp"
#include "host/io/volume/header_bytes.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace clvr {

namespace {

constexpr double angstrom_mm = 1e-7;
constexpr std::int32_t imod_stamp = 1146047817;

/// Byte offsets of the header's words: the format's documents count words from 1.
constexpr std::size_t word(std::size_t n) { return 4 * (n - 1); }

/// Whether the file calls itself a map, as all since the year 2000 do.
bool marked(const HeaderBytes& h) { return h.text(word(53), 3) == "MAP"; }

bool known_mode(std::int32_t mode) { return (mode >= 0 && mode <= 4) || mode == 6 || mode == 12 || mode == 16 || mode == 101; }

bool plausible(const HeaderBytes& h) {
    for (std::size_t n = 1; n <= 3; ++n)
        if (const auto size = h.at<std::int32_t>(word(n)); size < 1 || size > 1 << 24) return false;
    bool seen[4] = {};
    for (std::size_t n = 17; n <= 19; ++n) {
        const auto axis = h.at<std::int32_t>(word(n));
        if (axis < 0 || axis > 3 || (axis > 0 && seen[axis])) return false;
        seen[axis] = true;
    }
    return known_mode(h.at<std::int32_t>(word(4))) && h.at<std::int32_t>(word(24)) >= 0;
}

SampleType sample_type(const HeaderBytes& h, const std::string& path, std::vector<std::string>& decisions) {
    switch (const auto mode = h.at<std::int32_t>(word(4))) {
    case 0:
        if (h.at<std::int32_t>(word(39)) == imod_stamp && (h.at<std::int32_t>(word(40)) & 1) == 0) {
            decisions.push_back("bytes are unsigned, as IMOD's flags say");
            return SampleType::u8;
        }
        decisions.push_back("bytes are signed (MRC mode 0)");
        return SampleType::i8;
    case 1:
        return SampleType::i16;
    case 2:
        return SampleType::f32;
    case 6:
        return SampleType::u16;
    case 12:
        return SampleType::f16;
    case 3:
    case 4:
        bad_file(path, "the voxels are complex numbers (MRC mode {}): clvr renders scalar volumes, store the magnitude", mode);
    case 16:
        bad_file(path, "the voxels are RGB colours (MRC mode 16): clvr renders scalar volumes, extract one channel");
    case 101:
        bad_file(path, "the voxels have 4 bits (MRC mode 101): convert the file to mode 0, for instance with newstack -mode 0");
    default:
        bad_file(path, "its MRC mode {} is not known: expected 0, 1, 2, 6 or 12", mode);
    }
}

/// Which of x, y, z (0 to 2) the file's columns, rows and sections stand for.
std::array<std::size_t, 3> axes_of(const HeaderBytes& h, const std::string& path, std::vector<std::string>& decisions) {
    std::array<std::int32_t, 3> map;
    for (std::size_t i = 0; i < 3; ++i) map[i] = h.at<std::int32_t>(word(17 + i));
    if (map == std::array<std::int32_t, 3>{0, 0, 0}) map = {1, 2, 3}; // old files
    std::array<std::size_t, 3> axes;
    for (std::size_t i = 0; i < 3; ++i) {
        if (map[i] < 1 || map[i] > 3 || std::count(map.begin(), map.end(), map[i]) > 1)
            bad_file(path, "columns, rows and sections are the axes {}, {}, {} (MAPC, MAPR, MAPS): expected 1, 2 and 3 in some order",
                     map[0], map[1], map[2]);
        axes[i] = static_cast<std::size_t>(map[i] - 1);
    }
    if (map != std::array<std::int32_t, 3>{1, 2, 3})
        decisions.push_back(fmt::format("columns, rows and sections are the axes {}, {}, {}: turned to x, y, z", "xyz"[axes[0]],
                                        "xyz"[axes[1]], "xyz"[axes[2]]));
    return axes;
}

/// Columns: where the cell's edges a, b, c point; a along x, b in the plane of x and y.
Matrix3 edges_of(const HeaderBytes& h, std::vector<std::string>& notes) {
    Double3 cosine{0, 0, 0};
    bool right = true, usable = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const double angle = h.at<float>(word(14 + i));
        if (angle == 0 || angle == 90) continue;
        right = false;
        usable &= angle > 0 && angle < 180;
        cosine[i] = std::cos(angle * M_PI / 180);
    }
    Matrix3 m;
    if (right) return m;
    const auto [alpha, beta, gamma] = cosine;
    const double sine = std::sqrt(1 - gamma * gamma), y = (alpha - beta * gamma) / sine, z = std::sqrt(1 - beta * beta - y * y);
    if (!usable || !(z > 1e-3)) {
        notes.push_back("the angles of its cell are not usable: right angles are assumed");
        return m;
    }
    m.row = {{{1, gamma, beta}, {0, sine, y}, {0, 0, z}}};
    return m;
}

/// Spacing, origin and direction: voxel sizes are cell lengths over the cell's intervals.
void set_geometry(Voxels& v, const HeaderBytes& h, const std::array<std::size_t, 3>& axes, const VolumeReadOptions& options) {
    std::optional<Double3> spacing = Double3{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double size = h.at<float>(word(11 + i)) / h.at<std::int32_t>(word(8 + i)) * angstrom_mm;
        if (!(size > 0) || !std::isfinite(size)) {
            spacing.reset();
            break;
        }
        (*spacing)[i] = size;
    }
    set_spacing(v, options, spacing);
    if (!spacing) return; // an origin in angstroms would not fit assumed millimetres
    v.geometry.direction = edges_of(h, v.notes);
    Double3 origin{0, 0, 0}, start{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        if (marked(h)) origin[i] = h.at<float>(word(50 + i)) * angstrom_mm; // labels of text in old files
        start[axes[i]] = h.at<std::int32_t>(word(5 + i));
    }
    const auto is_zero = [](const Double3& x) { return x[0] == 0 && x[1] == 0 && x[2] == 0; };
    if (!is_zero(origin)) {
        v.geometry.origin = origin;
        if (!is_zero(start)) v.decisions.push_back("the origin is that of ORIGIN, not that of NXSTART, NYSTART, NZSTART");
    } else {
        v.geometry.origin = v.geometry.to_world(start);
    }
}

/// How many volumes stand one after the other; image stacks are one.
std::int64_t count_volumes(const HeaderBytes& h, std::int64_t sections, const std::string& path, Voxels& v) {
    const auto group = h.at<std::int32_t>(word(23));
    const std::int64_t each = h.at<std::int32_t>(word(10)); // MZ
    if (group == 0 && sections > 1)
        (each == sections ? v.decisions : v.notes)
            .push_back(fmt::format("the file is a stack of images (space group 0): its {} images are taken as slices", sections));
    if (group < 401 || group > 630) return 1;
    if (each < 1 || sections % each != 0)
        bad_file(path, "a stack of volumes (space group {}) of {} sections in all, {} in each: they do not fit", group, sections, each);
    return sections / each;
}

HeaderBytes read_mrc_header(ByteStream& stream, const std::string& path) {
    std::string bytes(mrc_header_bytes, '\0');
    if (const std::size_t got = stream.read(bytes.data(), bytes.size()); got < bytes.size())
        bad_file(path, "expected an MRC header of {} bytes, found {}: the file is truncated", bytes.size(), got);
    const HeaderBytes little(bytes, must_swap(false)), big(bytes, must_swap(true));
    const bool big_first = static_cast<unsigned char>(bytes[word(54)]) == 0x11; // the machine stamp
    if (big_first && plausible(big)) return big;
    if (plausible(little)) return little;
    if (plausible(big)) return big;
    bad_file(path, "not an MRC file: its sizes, mode or axes make no sense in either byte order ({} x {} x {}, mode {})",
             little.at<std::int32_t>(word(1)), little.at<std::int32_t>(word(2)), little.at<std::int32_t>(word(3)),
             little.at<std::int32_t>(word(4)));
}

} // namespace

bool is_mrc_header(const std::string& head) {
    if (head.size() < mrc_header_bytes) return false;
    const HeaderBytes little(head, false), big(head, true);
    return marked(little) && (plausible(little) || plausible(big));
}

Voxels read_mrc(const std::string& path, const VolumeReadOptions& options) {
    ByteStream stream = open_inside(path);
    const HeaderBytes h = read_mrc_header(stream, path);
    Voxels v;
    const SampleType type = sample_type(h, path, v.decisions);
    describe(v, path, "MRC", type);
    const auto axes = axes_of(h, path, v.decisions);
    std::array<std::int64_t, 3> stored; // columns, rows, sections
    for (std::size_t i = 0; i < 3; ++i) stored[i] = h.at<std::int32_t>(word(1 + i));
    const std::int64_t volumes = count_volumes(h, stored[2], path, v);
    stored[2] /= volumes;
    FileDims size;
    std::array<std::uint64_t, 3> stride;
    std::uint64_t step = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        size[axes[i]] = stored[i];
        stride[axes[i]] = step;
        step *= static_cast<std::uint64_t>(stored[i]);
    }
    const CheckedDims dims = check_dims(size, volumes, type, path);
    v.dims = dims.dims;
    check_frame(options.frame, volumes, path);
    v.frames = say_frame(options.frame, volumes, "the stack of volumes", v.decisions);
    set_geometry(v, h, axes, options);
    check_geometry(v.geometry, path);

    const std::uint64_t offset = mrc_header_bytes + static_cast<std::uint64_t>(h.at<std::int32_t>(word(24))); // the extended header
    check_capacity(dims.bytes, stream.capacity() - std::min(stream.capacity(), offset), path);
    stream.skip(offset - mrc_header_bytes + dims.frame_bytes * static_cast<std::uint64_t>(options.frame));
    const auto read = [&](void* to, std::size_t bytes) { return stream.read(to, bytes); };
    if (axes == std::array<std::size_t, 3>{0, 1, 2})
        read_samples(stream, type, h.swapped(), v);
    else
        read_reordered(read, type, h.swapped(), step, {0, stride}, v);
    stream.drain();
    if (stream.position() < offset + dims.bytes)
        bad_file(path, "expected {} bytes of voxels, found {}: the file is truncated", dims.bytes,
                 stream.position() - std::min(stream.position(), offset));
    if (stream.position() > offset + dims.bytes)
        v.notes.push_back(fmt::format("{} bytes after the voxels were ignored", stream.position() - offset - dims.bytes));
    return v;
}

} // namespace clvr
