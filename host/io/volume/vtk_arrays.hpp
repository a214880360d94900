// What legacy and XML files of VTK share: data arrays over the points or the cells of a regular grid.
#pragma once
#include "host/io/volume/samples.hpp"
#include "host/volume/volume_read_options.hpp"

#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// A data array as its header names it.
struct VtkArray {
    std::string name;
    std::string type_name;          ///< as the file says it
    std::optional<SampleType> type; ///< nothing for what holds no numbers that clvr reads ("string", "bit")
    std::int64_t components = 1;
    bool of_cells = false;
    bool active = false; ///< the file's own choice of scalars
};

/// The array that --array names, by its place in `arrays`. Without it: the file's active scalars, else the first array with one
/// component, else the first; those of points before those of cells; where there is more than one, a note says so. Throws Error{input}
/// naming those that are there.
std::size_t choose_array(const std::vector<VtkArray>& arrays, const VolumeReadOptions& options, Voxels& v);

/// The points of a regular grid: `points` along each axis, the first at geometry.origin.
struct VtkGrid {
    FileDims points{1, 1, 1};
    Geometry geometry;

    /// The samples of an array of points or of cells along each axis: one cell less than points, but at least one.
    FileDims samples(bool of_cells) const;
    /// Where they lie: cells have their centres half a step behind the points.
    Geometry placed(bool of_cells) const;
};

} // namespace clvr
