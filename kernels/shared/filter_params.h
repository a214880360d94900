// The classical denoisers on the device: their planes and settings.
#ifndef CLVR_SHARED_FILTER_PARAMS_H
#define CLVR_SHARED_FILTER_PARAMS_H
#include "shared/types.h"
CLVR_SHARED_BEGIN

/// Planes of `plane` floats, `pad` zeros around: pixel (x, y) is float (y + pad) row + pad + x. The colour is demodulated radiance over
/// opacity (3 planes), then the variance of its luminance (a-trous alone); the features are opacity (how much the pixel counts, 0 outside),
/// albedo R G B, normal X Y Z, depth.
typedef struct FilterParams {
    int width, height;   ///< [pixels]
    int row, plane, pad; ///< [floats]
    int radius;          ///< of the window: pixels, or taps that are `step` apart
    int step;            ///< [pixels]
    float spatial;       ///< -1 / (2 sigma^2) of the distance [1/pixel^2]
    float feature;       ///< -1 / (2 sigma^2) of the features' distance
    float colour;        ///< 1 / sigma of the luminance's distance in standard deviations
} FilterParams;
CLVR_CHECK_SIZE(FilterParams, 40);

#define CLVR_FILTER_FEATURES 8

CLVR_SHARED_END
#endif
