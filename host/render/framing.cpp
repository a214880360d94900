#include "host/render/framing.hpp"
#include "host/render/params.hpp"

namespace clvr {

std::vector<Double3> framing_outline(const Classified& c, const Scene& scene) {
    constexpr double faint = 0.02;
    std::vector<float> clear = c.majorants;
    for (float& m : clear)
        if (m <= faint) m = 0;
    return visible_outline(c.voxels->geometry, *c.grid, clear, visible_box(*c.voxels, *c.grid, c.table, faint),
                           clip_box_index(scene, *c.voxels));
}

} // namespace clvr
