// What the axes of a NRRD file mean: space, times, channels.
#pragma once
#include "host/io/volume/nrrd_header.hpp"
#include "host/io/volume/payload.hpp"
#include "host/volume/volume_read_options.hpp"

namespace clvr {

struct NrrdAxes {
    std::vector<std::int64_t> sizes;  ///< of all axes, the fastest first
    std::vector<std::size_t> spatial; ///< numbers of the axes of space, one to three
    std::vector<OtherAxis> others;    ///< of more than one index, the fastest first, chosen by --frame and --channel
};

/// Which axes are of space (by kinds, directions and order), and which index of the others is wanted: said in v. Throws Error{input} for
/// colours, tensors, more than one axis of times or of channels, an index that is not there.
NrrdAxes nrrd_axes(const NrrdHeader& h, const VolumeReadOptions& options, Voxels& v);

/// Sets v.geometry from space, directions or spacings, origin or mins, units: in millimetres and LPS. Throws Error{input}.
void place_nrrd(const NrrdHeader& h, const NrrdAxes& axes, Voxels& v);

} // namespace clvr
