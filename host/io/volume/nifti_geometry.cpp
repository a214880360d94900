// NIfTI's three ways to say where the voxels lie, as in nifti1.h: method 3 (sform), 2 (qform), 1 (voxel sizes alone).
#include "host/io/volume/nifti_header.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace clvr {

namespace {

/// Index to world in RAS, in the file's unit.
struct Affine {
    Matrix3 axes;
    Double3 origin{0, 0, 0};
};

/// Why it is no map of indices to space; empty where it is one.
std::string defect(const Affine& a) {
    Matrix3 unit;
    for (int j = 0; j < 3; ++j) {
        const double length = norm(a.axes.column(j));
        if (!std::isfinite(length) || !std::isfinite(a.origin[j])) return "not finite";
        if (length == 0) return "a column of zeros";
        for (int i = 0; i < 3; ++i) unit.row[i][j] = a.axes.row[i][j] / length;
    }
    return std::abs(unit.determinant()) < 1e-3 ? "singular" : "";
}

Affine sform_of(const NiftiHeader& h) {
    Affine a;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) a.axes.row[i][j] = h.srow[i][j];
        a.origin[i] = h.srow[i][3];
    }
    return a;
}

/// The square of the first part of the quaternion, from b, c, d; below 0 where they are too long for a rotation.
double first_part_squared(const NiftiHeader& h) {
    const auto [b, c, d] = h.quatern;
    return 1 - (b * b + c * c + d * d);
}
constexpr double rounding = -1e-5, too_long = -1e-2;

/// Nothing where the quaternion is no rotation; one that is a little too long is brought to length 1.
std::optional<Affine> qform_of(const NiftiHeader& h, const Double3& spacing) {
    const double rest = first_part_squared(h);
    if (!(rest > too_long)) return std::nullopt;
    const double scale = rest > rounding ? 1 : 1 / std::sqrt(1 - rest);
    const double b = h.quatern[0] * scale, c = h.quatern[1] * scale, d = h.quatern[2] * scale, a = std::sqrt(std::max(rest, 0.0));
    const double handed = h.pixdim[0] < 0 ? -1 : 1;
    Affine q;
    q.axes.row = {{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                   {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
                   {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c}}};
    for (auto& row : q.axes.row) row = {row[0] * spacing[0], row[1] * spacing[1], row[2] * spacing[2] * handed};
    q.origin = h.qoffset;
    return q;
}

/// Whether the two put any corner of the volume farther apart than a hundredth of the smallest voxel edge.
bool disagree(const Affine& a, const Affine& b, const std::array<std::int64_t, 8>& sizes) {
    double edge = norm(a.axes.column(0)), apart = 0;
    for (int j = 1; j < 3; ++j) edge = std::min(edge, norm(a.axes.column(j)));
    for (unsigned corner = 0; corner < 8; ++corner)
        for (int i = 0; i < 3; ++i) {
            double d = a.origin[i] - b.origin[i];
            for (unsigned j = 0; j < 3; ++j)
                if (corner >> j & 1) d += (a.axes.row[i][j] - b.axes.row[i][j]) * static_cast<double>(sizes[j + 1] - 1);
            apart = std::max(apart, std::abs(d));
        }
    return !(apart <= 0.01 * edge);
}

/// pixdim as voxel sizes. One that is 0 along an axis of a single voxel counts as 1, as nothing there has that size. Nothing where
/// another is not usable.
std::optional<Double3> sizes_of_voxel(const NiftiHeader& h, const std::array<std::int64_t, 8>& sizes, bool& assumed) {
    Double3 spacing{1, 1, 1};
    for (std::size_t i = 0; i < 3 && (h.dim[0] < 1 || static_cast<std::int64_t>(i) < h.dim[0]); ++i) {
        spacing[i] = std::abs(h.pixdim[i + 1]);
        if (spacing[i] > 0 && std::isfinite(spacing[i])) continue;
        if (sizes[i + 1] != 1) return std::nullopt;
        spacing[i] = 1;
        assumed = true;
    }
    return spacing;
}

double millimetres(int units, HeaderRemarks& remarks) {
    switch (units & 7) { // the low three bits are the unit of space
    case 1:
        return 1000;
    case 2:
        return 1;
    case 3:
        return 1e-3;
    case 0:
        remarks.decisions.push_back("the file gives no unit of length: mm is taken");
        return 1;
    default:
        remarks.notes.push_back(
            fmt::format("unknown unit of length {}, expected metres (1), millimetres (2) or micrometres (3): mm is assumed", units & 7));
        return 1;
    }
}

Affine choose(const NiftiHeader& h, const std::array<std::int64_t, 8>& sizes, const std::string& path, HeaderRemarks& remarks) {
    bool assumed = false;
    const auto voxel = sizes_of_voxel(h, sizes, assumed);
    const std::string pixdim = fmt::format("{:g} x {:g} x {:g} (pixdim)", h.pixdim[1], h.pixdim[2], h.pixdim[3]);
    const Affine sform = sform_of(h);
    const std::string sform_defect = defect(sform);
    const auto quaternion = voxel ? qform_of(h, *voxel) : std::nullopt;
    const bool qform_usable = quaternion && defect(*quaternion).empty();

    if (h.sform > 0 && sform_defect.empty()) {
        if (!voxel) remarks.notes.push_back(fmt::format("the voxel size {} is not usable: the spacing is that of the sform", pixdim));
        if (h.qform > 0 && qform_usable && disagree(sform, *quaternion, sizes))
            remarks.decisions.push_back("sform and qform disagree: the sform is taken");
        return sform;
    }
    std::string because; // why the other forms were passed over
    if (h.sform > 0) because = fmt::format("the sform is not usable ({})", sform_defect);
    if (h.qform > 0 && !qform_usable)
        because +=
            fmt::format("{}the qform is not usable ({})", because.empty() ? "" : ", ",
                        !voxel        ? "voxel size " + pixdim
                        : !quaternion ? fmt::format("quaternion {:g} {:g} {:g} is longer than 1", h.quatern[0], h.quatern[1], h.quatern[2])
                                      : defect(*quaternion));
    const auto say = [&](const char* taken) {
        if (!because.empty()) remarks.notes.push_back(fmt::format("{}: {}", because, taken));
        if (assumed) remarks.notes.push_back(fmt::format("the voxel size is {}: 1 mm along an axis of one voxel is assumed", pixdim));
    };
    if (h.qform > 0 && qform_usable) {
        if (first_part_squared(h) <= rounding)
            remarks.decisions.push_back("the quaternion of the qform is a little longer than 1: taken at length 1");
        say("the qform is taken");
        return *quaternion;
    }
    if (h.sform <= 0 && sform_defect.empty() && (h.qform > 0 || !voxel)) {
        if (because.empty()) because = fmt::format("the voxel size {} is not usable", pixdim);
        assumed = false;
        say("the matrix of the sform is taken, though its code is 0");
        return sform;
    }
    if (!voxel)
        bad_file(path, "the voxel size {} is not usable: each must be finite and not 0{}{}", pixdim, because.empty() ? "" : "; ", because);
    say("the voxel sizes (pixdim) alone are taken, orientation and origin are unknown");
    Affine sizes_alone;
    for (int i = 0; i < 3; ++i) sizes_alone.axes.row[i][i] = (*voxel)[i];
    return sizes_alone;
}

} // namespace

Geometry nifti_geometry(const NiftiHeader& h, const std::array<std::int64_t, 8>& sizes, const std::string& path, HeaderRemarks& remarks) {
    const double scale = millimetres(h.units, remarks);
    Affine a = choose(h, sizes, path, remarks);
    Geometry g;
    const Double3 to_lps{-1, -1, 1};
    for (int i = 0; i < 3; ++i) {
        g.origin[i] = to_lps[i] * a.origin[i] * scale;
        for (int j = 0; j < 3; ++j) a.axes.row[i][j] *= to_lps[i] * scale;
    }
    for (int j = 0; j < 3; ++j) {
        g.spacing[j] = norm(a.axes.column(j));
        for (int i = 0; i < 3; ++i) g.direction.row[i][j] = a.axes.row[i][j] / g.spacing[j];
    }
    check_geometry(g, path);
    return g;
}

} // namespace clvr
