// VTK's XML files of image data (docs.vtk.org, "VTK File Formats").
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/vti_header.hpp"
#include "host/io/volume/vti_pieces.hpp"

#include <algorithm>

namespace clvr {

Voxels read_vti(const std::string& path, const VolumeReadOptions& options) {
    Voxels v;
    v.source = path;
    const VtiHeader h(path, v.decisions);
    const VtkArray& array = h.arrays()[choose_array(h.arrays(), options, v)];
    describe(v, path, "VTK XML image", *array.type);
    const std::int64_t frames = h.time_steps(array);
    check_frame(options.frame, frames, path);
    v.frames = say_frame(options.frame, frames, "its time steps", v.decisions);
    const auto channel = chosen_channel(options, array.components, path, v.notes);
    v.dims = check_dims(h.grid().samples(array.of_cells), array.components, *array.type, path).dims;
    v.geometry = h.grid().placed(array.of_cells);
    check_geometry(v.geometry, path);
    if (!h.spaced()) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed");
    read_vti_pieces(h, array, options.frame, channel, v);
    return v;
}

} // namespace clvr
