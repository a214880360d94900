// NIfTI-1 and NIfTI-2: header layout as in nifti1.h and nifti2.h of the NIfTI-1.1 and NIfTI-2 standards.
#include "host/io/volume/nifti_header.hpp"
#include "host/io/volume/header_bytes.hpp"

namespace clvr {

namespace {

constexpr std::size_t nifti1_bytes = 348, nifti2_bytes = 540;

/// 1 or 2, by the size of itself that every header begins with; 0 where it is no such size.
int version_of(const HeaderBytes& h) {
    const auto size = static_cast<std::size_t>(h.at<std::int32_t>(0));
    return size == nifti1_bytes ? 1 : size == nifti2_bytes ? 2 : 0;
}
std::string mark_of(const HeaderBytes& h, int version) { return version == 2 ? h.text(4, 4) : h.text(344, 4); }

/// Both versions hold the same fields with other types at other places: dims and pixdim, then the rest.
template <class Dim, class Real, class Code>
NiftiHeader parse(const HeaderBytes& f, std::size_t dim, std::size_t pixdim, std::size_t scale, std::size_t qform, std::size_t quatern) {
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

} // namespace

bool is_single_nifti(const std::string& head) {
    if (head.size() < nifti1_bytes) return false;
    for (const bool swapped : {false, true}) {
        const HeaderBytes h(head.substr(0, nifti1_bytes), swapped);
        if (const int version = version_of(h)) return mark_of(h, version) == (version == 2 ? "n+2" : "n+1");
    }
    return false;
}

NiftiHeader read_nifti_header(ByteStream& stream, const std::string& path) {
    std::string bytes(nifti2_bytes, '\0');
    std::size_t got = stream.read(bytes.data(), nifti1_bytes);
    if (got < nifti1_bytes) bad_file(path, "expected a NIfTI header of {} bytes, found {}: the file is truncated", nifti1_bytes, got);
    bool swapped = false;
    int version = version_of({bytes, swapped});
    if (version == 0) version = version_of({bytes, swapped = true});
    if (version == 0)
        bad_file(path, "not a NIfTI file: its first number is {}, expected {} or {}", HeaderBytes(bytes, false).at<std::int32_t>(0),
                 nifti1_bytes, nifti2_bytes);
    const std::string mark = mark_of({bytes, swapped}, version), single = version == 2 ? "n+2" : "n+1", pair = version == 2 ? "ni2" : "ni1";
    if (mark != single && mark != pair)
        bad_file(path, "the NIfTI mark \"{}\" or \"{}\" is missing (ANALYZE 7.5 files have no orientation: convert them to NIfTI)", single,
                 pair);
    NiftiHeader h;
    if (version == 2) {
        got += stream.read(bytes.data() + nifti1_bytes, nifti2_bytes - nifti1_bytes);
        if (got < nifti2_bytes) bad_file(path, "expected a NIfTI-2 header of {} bytes, found {}: the file is truncated", nifti2_bytes, got);
        const HeaderBytes f(bytes, swapped);
        h = parse<std::int64_t, double, std::int32_t>(f, 16, 104, 176, 344, 352);
        h.datatype = f.at<std::int16_t>(12);
        h.voxel_offset = static_cast<double>(f.at<std::int64_t>(168));
        h.units = f.at<std::int32_t>(500);
        h.intent = f.at<std::int32_t>(504);
    } else {
        const HeaderBytes f(bytes, swapped);
        h = parse<std::int16_t, float, std::int16_t>(f, 40, 76, 112, 252, 256);
        h.datatype = f.at<std::int16_t>(70);
        h.voxel_offset = f.at<float>(108);
        h.units = f.at<std::uint8_t>(123);
        h.intent = f.at<std::int16_t>(68);
    }
    h.version = version;
    h.swapped = swapped;
    h.pair = mark == pair;
    return h;
}

std::array<std::int64_t, 8> nifti_sizes(const NiftiHeader& h, const std::string& path, HeaderRemarks& remarks) {
    std::int64_t axes = h.dim[0];
    if (axes < 1 || axes > 7) {
        axes = 0;
        while (axes < 7 && h.dim[static_cast<std::size_t>(axes) + 1] > 0) ++axes;
        if (axes < 3) bad_file(path, "the header says {} dimensions, expected 1 to 7", h.dim[0]);
        remarks.notes.push_back(
            fmt::format("the header says {} dimensions, expected 1 to 7: the {} axes that have a size are taken", h.dim[0], axes));
    }
    std::array<std::int64_t, 8> sizes;
    sizes.fill(1);
    for (std::size_t axis = 1; axis <= static_cast<std::size_t>(axes); ++axis) {
        sizes[axis] = h.dim[axis];
        if (axis > 3 && sizes[axis] == 0) { // some writers count an axis that they leave empty
            sizes[axis] = 1;
            remarks.decisions.push_back(fmt::format("size 0 of axis {} taken as 1", axis));
        }
    }
    return sizes;
}

} // namespace clvr
