// The camera as the kernels need it, and its framing.
#pragma once
#include "host/appearance/visible_box.hpp"
#include "host/render/scene.hpp"

#include <vector>

namespace clvr {

/// A camera in world space. `right` and `up` are half the picture's extent: at distance 1 for perspective, in mm for orthographic.
struct View {
    bool orthographic = false;
    Double3 eye, forward, right, up;
};

/// World positions that outline what is visible: the corners of each visible majorant cell, cut to `visible` (and to the clip box `clip`,
/// index space). Falls back to the corners of the volume when nothing is visible.
std::vector<Double3> visible_outline(const Geometry& geometry, const MajorantGrid& grid, const std::vector<float>& cell_majorants,
                                     const IndexBox& visible, const IndexBox& clip);

/// The middle of the points' box; there is a point.
Double3 centre_of(const std::vector<Double3>& points);

/// Resolves the scene's camera. Without eye and target it looks from azimuth and elevation at the outline, as near as it fits with a
/// margin. `steady`: the target is the outline's centre and the distance that of the widest azimuth, so that a turntable neither sways nor
/// breathes.
View resolve_view(const Scene& scene, const std::vector<Double3>& outline, bool steady);

/// Azimuth of the view [degrees], as Camera::azimuth counts it.
double view_azimuth(const View& view, double fallback);

} // namespace clvr
