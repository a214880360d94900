// Direct light as the features hold it: few exact directions, and the rest as spherical harmonics at the corners of a coarse grid.
#ifndef CLVR_SHARED_LIGHT_PARAMS_H
#define CLVR_SHARED_LIGHT_PARAMS_H
#include "shared/types.h"
CLVR_SHARED_BEGIN

#define CLVR_KEYS_MAX 6                         ///< key light, headlight, suns of an environment image
#define CLVR_SKY_TERMS 9                        ///< real spherical harmonics up to order 2
#define CLVR_SKY_DIRECTIONS 64                  ///< a multiple of every packet width
#define CLVR_LIGHT_SUMS(keys) (11 + 3 * (keys)) ///< numbers of a ray's LightSums (lib/light_sums.clh)

/// Light from one direction, or from a small disc around it. World space, unit vectors.
typedef struct KeyLight {
    float4
        direction; ///< towards the light; w: sine of the radius of the disc's circle that halves its solid angle (0: a directional light)
    float4 right, up;  ///< with `direction` an orthonormal frame
    float4 irradiance; ///< linear RGB, of a surface that faces the light
} KeyLight;
CLVR_CHECK_SIZE(KeyLight, 64);

/// The grid of sky light: corners at multiples of an edge in voxels, the last ones at or beyond the last voxel.
typedef struct SkyGrid {
    int4 corners;   ///< xyz: their number along each axis
    int4 log2_edge; ///< xyz: of a cell [voxels]
    float4 voxel;   ///< x: the greatest spacing [mm]
} SkyGrid;
CLVR_CHECK_SIZE(SkyGrid, 48);

CLVR_SHARED_END
#endif
