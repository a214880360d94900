// One level of the edge-avoiding a-trous wavelet (H. Dammertz et al. 2010) with variance (C. Schied et al. 2017, "SVGF", section 4.3): 5x5
// taps of the B3 spline, `step` pixels apart; luminance may differ by as much as its standard deviation says; the variance is filtered
// along.
#include "lib/filter.clh"

// Variance around a pixel, 3x3 binomial: single estimates are as noisy as what they estimate.
static inline vfloat smooth_variance(__constant FilterParams* p, __global const float* features, __global const float* variance,
                                     int centre) {
    vfloat weights = (vfloat)(0.0f), sum = weights;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            int at = centre + j * p->row + i;
            vfloat opacity = v_load(features + at), tap = (vfloat)((float)((2 - i * i) * (2 - j * j)));
            weights = fma(opacity, tap, weights);
            sum = fma(opacity * tap, v_load(variance + at), sum);
        }
    return sum / v_select(v_gt(weights, (vfloat)(0.0f)), weights, (vfloat)(1.0f));
}

// `colour`, `out`: 3 planes and the variance.
__kernel void wavelet(__constant FilterParams* p, __global const float* features, __global const float* colour, __global float* out) {
    const float spline[3] = {0.375f, 0.25f, 0.0625f};
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1);
    if (x >= p->width || y >= p->height) return;
    int centre = pixel_at(p, x, y);
    Features here = load_features(p, features, centre);
    vfloat deviation = sqrt(smooth_variance(p, features, colour + 3 * p->plane, centre));
    vfloat sharpness = -p->colour / (deviation + 1e-4f);
    vfloat level = luminance(v_load(colour + centre), v_load(colour + p->plane + centre), v_load(colour + (size_t)2 * (size_t)p->plane + centre));
    vfloat weights = (vfloat)(0.0f), sum[4] = {weights, weights, weights, weights};
    for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
            int at = centre + (j * p->row + i) * p->step;
            Features there = load_features(p, features, at);
            vfloat c[3];
            for (int k = 0; k < 3; ++k) c[k] = v_load(colour + (size_t)k * (size_t)p->plane + at);
            vfloat apart = v_min(fabs(luminance(c[0], c[1], c[2]) - level), (vfloat)(1e6f));
            vfloat exponent = fma(feature_distance(&here, &there), (vfloat)(p->feature), apart * sharpness);
            vfloat tap = v_load(features + at) * (spline[i < 0 ? -i : i] * spline[j < 0 ? -j : j]), near = v_exp(exponent), w = tap * near;
            weights = fma(tap, near, weights);
            for (int k = 0; k < 3; ++k) sum[k] = fma(w, c[k], sum[k]);
            sum[3] = fma(w * w, v_load(colour + (size_t)3 * (size_t)p->plane + at), sum[3]);
        }
    vmask inside = v_lt((vint)(x) + v_iota, (vint)(p->width)), some = v_gt(weights, (vfloat)(0.0f)) & inside;
    vfloat divisor = v_select(some, weights, (vfloat)(1.0f));
    sum[3] = sum[3] / divisor;
    for (int k = 0; k < 4; ++k) v_store(v_select(some, sum[k] / divisor, (vfloat)(0.0f)), out + (size_t)k * (size_t)p->plane + centre);
}
