// What the headers of NIfTI-1 and NIfTI-2 say.
#pragma once
#include "host/io/volume/samples.hpp"
#include "host/volume/geometry.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace clvr {

/// What both header versions say, in one form.
struct NiftiHeader {
    int version = 1;
    bool swapped = false;
    bool pair = false;               ///< by its mark, header and voxels lie in two files
    std::array<std::int64_t, 8> dim; ///< dim[0] axes of sizes dim[1] ..., as the file says
    std::array<double, 8> pixdim;
    int datatype = 0, intent = 0, units = 0, qform = 0, sform = 0;
    double voxel_offset = 0, slope = 0, intercept = 0;
    std::array<double, 3> quatern, qoffset;
    std::array<std::array<double, 4>, 3> srow;
};

/// What a reader says about a header: becomes Voxels.notes and Voxels.decisions.
struct HeaderRemarks {
    std::vector<std::string> notes, decisions;
};

/// The first bytes of a file, 348 at least: whether they are a header whose mark says that the voxels follow in the same file.
bool is_single_nifti(const std::string& head);
/// Reads the header, up to its last byte. Throws Error{input} where it is none, or that of ANALYZE 7.5.
NiftiHeader read_nifti_header(ByteStream& stream, const std::string& path);
/// The sizes of axes 1 to 7, at [1] ...: 1 for an axis that is not there. Throws Error{input} where the number of axes makes no sense
/// and the sizes do not either.
std::array<std::int64_t, 8> nifti_sizes(const NiftiHeader& h, const std::string& path, HeaderRemarks& remarks);
/// Geometry in LPS mm by the sform, else the qform, else the voxel sizes alone; a form that is not usable is passed over, and that is
/// said. Throws Error{input} where none is usable. `sizes` are those of nifti_sizes.
Geometry nifti_geometry(const NiftiHeader& h, const std::array<std::int64_t, 8>& sizes, const std::string& path, HeaderRemarks& remarks);

} // namespace clvr
