// Slices the grids where the guides say, blends the levels, multiplies albedo and opacity back and adds the known light (kernels/denoise/README.md, "Slice" and
// "Blend"). A work-item takes CLVR_WIDTH pixels of a row.
#include "lib/grid.clh"
#include "lib/pixels.clh"

#ifndef CLVR_KNOWN // 1: light was taken off before (assemble.cl)
#define CLVR_KNOWN 0
#endif
#ifndef CLVR_SHOW // 1: also store each level's own result
#define CLVR_SHOW 0
#endif

// `planes`: a guide a level, then the blending weights. `known`: 3 planes an image. `out`: 3 planes an image; with CLVR_SHOW 3 more a level.
__kernel void slice(__constant DenoiseParams* p, __global const float* planes, __global const float4* cells, __global const float4* remodulation,
                    __global const float* known, __global float* out) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1), n = (int)get_global_id(2), outputs = 2 * p->levels - 1;
    if (x >= p->width || y >= p->height) return;
    size_t at = (size_t)(y * p->row + x);
    Colours albedo = load_colours(p, remodulation, n, x, y), blended = {(vfloat)(0.0f), (vfloat)(0.0f), (vfloat)(0.0f), (vfloat)(0.0f)};
    int channels = CLVR_SHOW ? 3 + 3 * p->levels : 3;
    vmask inside = v_lt((vint)(x) + v_iota, (vint)(p->width));
#define STORE(c, v) v_store(v_select(inside, v, (vfloat)(0.0f)), out + plane_start(p, n, channels, c) + at)

#if CLVR_KNOWN
#define LIT(k, v, factor) fma(v, factor, v_load(known + plane_start(p, n, 3, k) + at))
#else
#define LIT(k, v, factor) ((v) * (factor))
#endif

    vfloat rest = (vfloat)(1.0f);
    for (int l = 0; l < p->levels; ++l) {
        Neighbours near;
        find_neighbours(p, p->level + l, x, y, v_load(planes + plane_start(p, n, outputs, l) + at), &near);
        Sliced sliced = slice_grid(&near, cells + (size_t)n * p->cells);
        vfloat share = rest;
        if (l < p->levels - 1) {
            share = v_load(planes + plane_start(p, n, outputs, p->levels + l) + at);
            rest -= share;
        }
        blended.r = fma(share, sliced.r, blended.r);
        blended.g = fma(share, sliced.g, blended.g);
        blended.b = fma(share, sliced.b, blended.b);
#if CLVR_SHOW
        STORE(3 + 3 * l, LIT(0, sliced.r, albedo.r));
        STORE(4 + 3 * l, LIT(1, sliced.g, albedo.g));
        STORE(5 + 3 * l, LIT(2, sliced.b, albedo.b));
#endif
    }
    STORE(0, LIT(0, blended.r, albedo.r));
    STORE(1, LIT(1, blended.g, albedo.g));
    STORE(2, LIT(2, blended.b, albedo.b));
}
