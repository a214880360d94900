// Importance sampling tables of an HDR latitude-longitude image.
#pragma once
#include "kernels/shared/types.h"

#include <vector>

namespace clvr {

/// What kernels/lib/light.clh reads. Row 0 lies at +z, the image's centre towards +y, columns run clockwise as seen from above.
/// The density is that of the rounded distribution functions, so that samples and weights agree. Computed in double without libm.
struct EnvironmentTables {
    int width = 0, height = 0;
    std::vector<shared::float4> texel; ///< [h * w] linear RGB radiance, density [1/sr]
    std::vector<float> row_cdf;        ///< [h + 1]
    std::vector<float> column_cdf;     ///< [h * (w + 1)]
    std::vector<float> row_cos;        ///< [h + 1]
    double mean_luminance = 0;         ///< over the sphere
};

/// rgb: [h * w * 3] linear, finite, not negative. An all-black image gives a uniform density. `level` scales the radiance.
EnvironmentTables environment_tables(int width, int height, const std::vector<float>& rgb, double level);

/// cos(pi x) for x in 0..1, by a polynomial in double: the same bits whatever the C library.
double cos_half_turns(double x);

} // namespace clvr
