// From a scene to the structs that the kernels read: computed in double, rounded once.
#pragma once
#include "host/appearance/environment.hpp"
#include "host/render/view.hpp"
#include "host/volume/brick_layout.hpp"
#include "kernels/shared/render_params.h"
#include "kernels/shared/volume_params.h"

namespace clvr {

/// The scene's extinction at opacity 1, or 512 / diagonal of the volume where it is automatic [1/mm].
double resolved_extinction(const Scene& scene, const Voxels& v);

/// The scene's clip box in index space; the whole volume, [-0.5, n-0.5], without one.
IndexBox clip_box_index(const Scene& scene, const Voxels& v);

/// Geometry and classification. `bricks` of the result are filled from the layout.
shared::VolumeParams volume_params(const Scene& scene, const Voxels& v, const MajorantGrid& grid, const TransferTable& table,
                                   const BrickLayout& layout);

/// Camera, light, transport. `environment` may be empty (width 0).
shared::RenderParams render_params(const Scene& scene, const Voxels& v, const View& view, const EnvironmentTables& environment);

} // namespace clvr
