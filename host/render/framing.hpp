// What a camera without eye and target is framed to.
#pragma once
#include "host/render/classified.hpp"
#include "host/render/view.hpp"

namespace clvr {

/// World positions that outline what is visible of the classified volume within the scene's clip box; what is fainter than 2 % does not
/// count. Looks at the voxels.
std::vector<Double3> framing_outline(const Classified& c, const Scene& scene);

} // namespace clvr
