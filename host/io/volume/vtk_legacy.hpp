// The header of a legacy VTK file: grid and arrays, wherever in the file they stand (docs.vtk.org, "VTK File Formats").
#pragma once
#include "host/io/volume/vtk_arrays.hpp"

namespace clvr {

struct LegacyVtkArray {
    std::uint64_t position = 0; ///< of its values in the file
    bool unit_colors = false;   ///< numbers from 0 to 1 for bytes: COLOR_SCALARS as text
};

struct LegacyVtk {
    bool text = false; ///< ASCII; else big-endian
    VtkGrid grid;
    bool spaced = false; ///< the file gives a spacing
    std::vector<VtkArray> arrays;
    std::vector<LegacyVtkArray> places; ///< one for each array
};

/// Reads the whole file but for the values, which are counted: each array of the answer is complete in the file. Throws Error{input} for
/// what is no regular grid, a broken header, too few values.
LegacyVtk parse_legacy_vtk(const std::string& path, std::vector<std::string>& notes);

} // namespace clvr
