// Backwards through blending and slicing (kernels/denoise/README.md, "Backward"): the gradient of the loss by the blending weights, and what flows back to the
// cells of each level, as colours to splat. A work-item takes CLVR_WIDTH pixels of a row.
#include "lib/grid.clh"
#include "lib/pixels.clh"

// `gradient`: 3 planes, dL/dresult. `upstream`: float4 a pixel and level, all images of level 0 first: w_l U / S (xyz), where U = dL/dresult * albedo.
// `output_gradient`: as `planes`; the sums before the sigmoid of the blending weights are written.
__kernel void slice_gradient(__constant DenoiseParams* p, __global const float* planes, __global const float4* cells, __global const float4* remodulation,
                             __global const float* gradient, __global float4* upstream, __global float* output_gradient) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1), n = (int)get_global_id(2), outputs = 2 * p->levels - 1;
    if (x >= p->width || y >= p->height) return;
    int images = (int)get_global_size(2);
    size_t at = (size_t)(y * p->row + x);
    vmask inside = v_lt((vint)(x) + v_iota, (vint)(p->width));
    Colours u = load_colours(p, remodulation, n, x, y);
    u.r *= v_load(gradient + plane_start(p, n, 3, 0) + at);
    u.g *= v_load(gradient + plane_start(p, n, 3, 1) + at);
    u.b *= v_load(gradient + plane_start(p, n, 3, 2) + at);

    vfloat toward[CLVR_LEVELS_MAX]; // dL/d(share of a level)
    vfloat rest = (vfloat)(1.0f);
    for (int l = 0; l < p->levels; ++l) {
        Neighbours near;
        find_neighbours(p, p->level + l, x, y, v_load(planes + plane_start(p, n, outputs, l) + at), &near);
        Sliced sliced = slice_grid(&near, cells + (size_t)n * p->cells);
        toward[l] = fma(u.r, sliced.r, fma(u.g, sliced.g, u.b * sliced.b));
        vfloat share = rest;
        if (l < p->levels - 1) {
            share = v_load(planes + plane_start(p, n, outputs, p->levels + l) + at);
            rest -= share;
        }
        vmask some = v_gt(sliced.weight, (vfloat)(0.0f));
        vfloat scale = v_select(some, share / v_select(some, sliced.weight, (vfloat)(1.0f)), (vfloat)(0.0f));
        Colours up = {u.r * scale, u.g * scale, u.b * scale, (vfloat)(0.0f)};
        store_colours(p, upstream, l * images + n, x, y, up);
    }
    for (int l = 0; l < p->levels - 1; ++l) {
        size_t to = plane_start(p, n, outputs, p->levels + l) + at;
        vfloat w = v_load(planes + to);
        v_store(v_select(inside, (toward[l] - toward[p->levels - 1]) * (w * (1.0f - w)), (vfloat)(0.0f)), output_gradient + to);
    }
}
