// The pieces of a VTK image file, joined.
#pragma once
#include "host/io/volume/vti_header.hpp"

namespace clvr {

/// Reads one component of an array at one time step into v, whose dims, type and source are set. Throws Error{input} where the pieces do
/// not fill the grid, and for damage.
void read_vti_pieces(const VtiHeader& h, const VtkArray& array, int time_step, std::int64_t channel, Voxels& v);

} // namespace clvr
