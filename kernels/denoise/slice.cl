// Slices the grids where the guides say, blends the levels and multiplies albedo and opacity back (SPEC.md sections 6 and 7). One work-item a pixel.
#pragma OPENCL FP_CONTRACT OFF
#include "shared/denoise_params.h"
#include "lib/grid.clh"

#ifndef CLVR_SHOW // 1: also store each level's own result
#define CLVR_SHOW 0
#endif

// `planes`: a guide a level, then the blending weights. `out`: 3 planes an image; with CLVR_SHOW 3 more a level.
__kernel void slice(__constant DenoiseParams* p, __global const float* planes, __global const float4* cells, __global const float4* remodulation,
                    __global float* out) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1), n = (int)get_global_id(2), outputs = 2 * p->levels - 1;
    if (x >= p->width || y >= p->height) return;
    size_t pixel = ((size_t)n * (size_t)p->height + (size_t)y) * (size_t)p->width + (size_t)x, at = (size_t)(y * p->row + x);
    float4 albedo = remodulation[pixel];

    float4 blended = (float4)(0.0f);
    float rest = 1.0f;
    for (int l = 0; l < p->levels; ++l) {
        Neighbours near = neighbours_of(p, p->level + l, x, y, planes[plane_start(p, n, outputs, l) + at]);
        float4 sliced = slice_grid(p->level + l, &near, cells + (size_t)n * p->cells);
        float share = rest;
        if (l < p->levels - 1) {
            share = planes[plane_start(p, n, outputs, p->levels + l) + at];
            rest -= share;
        }
        blended = fma((float4)(share), sliced, blended);
#if CLVR_SHOW
        float4 shown = sliced * albedo;
        for (int k = 0; k < 3; ++k) out[plane_start(p, n, 3 + 3 * p->levels, 3 + 3 * l + k) + at] = k == 0 ? shown.x : k == 1 ? shown.y : shown.z;
#endif
    }
    float4 result = blended * albedo;
    int stride = CLVR_SHOW ? 3 + 3 * p->levels : 3;
    out[plane_start(p, n, stride, 0) + at] = result.x;
    out[plane_start(p, n, stride, 1) + at] = result.y;
    out[plane_start(p, n, stride, 2) + at] = result.z;
}
