// The cross-bilateral filter (E. Eisemann, F. Durand 2004; G. Petschnigg et al. 2004) guided by noise-free features: a weighted mean over a
// square window, weights by distance in the picture and between features.
#include "lib/filter.clh"

// `colour`, `out`: 3 planes.
__kernel void cross_bilateral(__constant FilterParams* p, __global const float* features, __global const float* colour,
                              __global float* out) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1);
    if (x >= p->width || y >= p->height) return;
    int centre = pixel_at(p, x, y);
    Features here = load_features(p, features, centre);
    vfloat weights = (vfloat)(0.0f), sum[3] = {weights, weights, weights};
    for (int j = -p->radius; j <= p->radius; ++j)
        for (int i = -p->radius; i <= p->radius; ++i) {
            int at = centre + j * p->row + i;
            Features there = load_features(p, features, at);
            vfloat spatial = (vfloat)((float)(i * i + j * j) * p->spatial);
            vfloat opacity = v_load(features + at), near = v_exp(fma(feature_distance(&here, &there), (vfloat)(p->feature), spatial));
            weights = fma(opacity, near, weights);
            vfloat w = opacity * near;
            for (int c = 0; c < 3; ++c) sum[c] = fma(w, v_load(colour + (size_t)c * (size_t)p->plane + at), sum[c]);
        }
    vmask inside = v_lt((vint)(x) + v_iota, (vint)(p->width)), some = v_gt(weights, (vfloat)(0.0f)) & inside;
    for (int c = 0; c < 3; ++c)
        v_store(v_select(some, sum[c] / v_select(some, weights, (vfloat)(1.0f)), (vfloat)(0.0f)), out + (size_t)c * (size_t)p->plane + centre);
}
