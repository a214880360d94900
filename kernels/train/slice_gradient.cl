// Backwards through blending and slicing (SPEC.md section 8): the loss by the blending weights, and what the cells of each level get, as colours to splat.
// One work-item a pixel.
#pragma OPENCL FP_CONTRACT OFF
#include "shared/denoise_params.h"
#include "lib/grid.clh"

// `gradient`: 3 planes, dL/dresult. `upstream`: float4 a pixel and level, all images of level 0 first: w_l U / S (xyz), where U = dL/dresult * albedo.
// `output_gradient`: as `planes`; the sums before the sigmoid of the blending weights are written.
__kernel void slice_gradient(__constant DenoiseParams* p, __global const float* planes, __global const float4* cells, __global const float4* remodulation,
                             __global const float* gradient, __global float4* upstream, __global float* output_gradient) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1), n = (int)get_global_id(2), outputs = 2 * p->levels - 1;
    if (x >= p->width || y >= p->height) return;
    size_t images = get_global_size(2), pixels = (size_t)p->width * (size_t)p->height;
    size_t pixel = (size_t)n * pixels + (size_t)(y * p->width + x), at = (size_t)(y * p->row + x);
    float4 albedo = remodulation[pixel];
    float4 u = (float4)(gradient[plane_start(p, n, 3, 0) + at] * albedo.x, gradient[plane_start(p, n, 3, 1) + at] * albedo.y,
                        gradient[plane_start(p, n, 3, 2) + at] * albedo.z, 0.0f);

    float toward[CLVR_LEVELS_MAX]; // dL/d(share of a level)
    float rest = 1.0f;
    for (int l = 0; l < p->levels; ++l) {
        Neighbours near = neighbours_of(p, p->level + l, x, y, planes[plane_start(p, n, outputs, l) + at]);
        float4 sliced = slice_grid(p->level + l, &near, cells + (size_t)n * p->cells);
        toward[l] = fma(u.x, sliced.x, fma(u.y, sliced.y, u.z * sliced.z));
        float share = rest;
        if (l < p->levels - 1) {
            share = planes[plane_start(p, n, outputs, p->levels + l) + at];
            rest -= share;
        }
        float scale = sliced.w > 0.0f ? share / sliced.w : 0.0f;
        upstream[(size_t)l * images * pixels + pixel] = (float4)(u.x * scale, u.y * scale, u.z * scale, 0.0f);
    }
    for (int l = 0; l < p->levels - 1; ++l) {
        size_t to = plane_start(p, n, outputs, p->levels + l) + at;
        float w = planes[to];
        output_gradient[to] = (toward[l] - toward[p->levels - 1]) * (w * (1.0f - w));
    }
}
