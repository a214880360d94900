// The variance of luminance where the renderer gave none (1 sample per pixel): that of similar pixels in a 7x7 window (C. Schied et al.
// 2017, "SVGF", section 4.2). Plane 3 of `colour`.
#include "lib/filter.clh"

#define RADIUS 3

__kernel void spatial_variance(__constant FilterParams* p, __global const float* features, __global float* colour) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1);
    if (x >= p->width || y >= p->height) return;
    int centre = pixel_at(p, x, y);
    Features here = load_features(p, features, centre);
    vfloat weights = (vfloat)(0.0f), first = weights, second = weights;
    for (int j = -RADIUS; j <= RADIUS; ++j)
        for (int i = -RADIUS; i <= RADIUS; ++i) {
            int at = centre + j * p->row + i;
            Features there = load_features(p, features, at);
            vfloat opacity = v_load(features + at), near = v_exp(feature_distance(&here, &there) * p->feature), w = opacity * near;
            vfloat l = luminance(v_load(colour + at), v_load(colour + p->plane + at), v_load(colour + (size_t)2 * (size_t)p->plane + at));
            weights = fma(opacity, near, weights);
            first = fma(w, l, first);
            second = fma(w * l, l, second);
        }
    vmask inside = v_lt((vint)(x) + v_iota, (vint)(p->width)), some = v_gt(weights, (vfloat)(0.0f)) & inside;
    vfloat divisor = v_select(some, weights, (vfloat)(1.0f)), mean = first / divisor;
    v_store(v_select(some, v_max(fma(-mean, mean, second / divisor), (vfloat)(0.0f)), (vfloat)(0.0f)), colour + (size_t)3 * (size_t)p->plane + centre);
}
