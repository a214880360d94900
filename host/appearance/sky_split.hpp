// An environment as the features see it: its suns as lights of one direction each, the rest as light from few directions.
#pragma once
#include "host/appearance/environment.hpp"
#include "kernels/shared/light_params.h"
#include "kernels/shared/render_params.h"

#include <vector>

namespace clvr {

struct SkySplit {
    std::vector<shared::KeyLight> suns;     ///< at most 4
    std::vector<shared::float4> directions; ///< [CLVR_SKY_DIRECTIONS] world, unit, spread evenly over the sphere
    std::vector<shared::float4> radiance;   ///< of each: linear RGB times its solid angle, 4 pi / CLVR_SKY_DIRECTIONS
};

/// Suns are the brightest spots of an image, 4 degrees wide to either side, that hold 5 % of its power and are 20 times as bright as its
/// mean. What is left goes to the nearest of the directions, so that suns and directions together have the environment's power. `params`
/// gives the sky without an image and the image's rotation. Computed in double without libm: the same bits everywhere.
SkySplit split_sky(const shared::RenderParams& params, const EnvironmentTables& environment);

} // namespace clvr
