// Which values of an HDF5 file are the volume, by the conventions of those who write it.
#pragma once
#include "host/io/volume/hdf5_file.hpp"
#include "host/volume/volume_read_options.hpp"
#include "host/volume/voxels.hpp"

#include <array>
#include <optional>

namespace clvr {

/// A block of a data set: along each axis of the file, `count` values from `start` on.
struct Hdf5Volume {
    Hdf5Dataset data;
    std::vector<std::uint64_t> start, count;
    std::array<std::optional<std::size_t>, 3> axis; ///< which axis of the file x, y and z are; the others have a count of 1
    Voxels described;                               ///< all but dims and bytes
    /// Slope and intercept of each entry along the slowest axis of the block, where they differ: the values become f32 then.
    std::vector<std::pair<double, double>> scales;
};

/// The data set `inside` names; an empty name or a group means the only one in it. All throw Error{input}.
Hdf5Volume plain_hdf5_volume(const Hdf5File& file, const std::string& inside, const VolumeReadOptions& options);

/// Files of Imaris (imaris.oxinst.com, "Imaris 5.5 file format"): resolution level 0 of one time and channel.
bool is_imaris(const Hdf5File& file);
Hdf5Volume imaris_volume(const Hdf5File& file, const VolumeReadOptions& options);

/// MINC 2 files (bic-mni.github.io, "MINC 2.0 file format reference"): geometry and scale as their dimensions and image say.
bool is_minc(const Hdf5File& file);
Hdf5Volume minc_volume(const Hdf5File& file, const VolumeReadOptions& options);

} // namespace clvr
