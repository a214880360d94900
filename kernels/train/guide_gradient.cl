// The loss by the guides, through slicing and splatting at once (SPEC.md section 8), then by the sums before their sigmoid. One work-item a pixel.
#pragma OPENCL FP_CONTRACT OFF
#include "shared/denoise_params.h"
#include "lib/grid.clh"

#ifndef CLVR_IMAGE_GRADIENT // 1: also the loss by the splatted colours (xyz) and weights (w), summed over the levels
#define CLVR_IMAGE_GRADIENT 0
#endif

static inline float inner(float4 a, float4 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

// `gradients`: A (xyz) and b (w) of each cell. `upstream` as slice_gradient writes it. `output_gradient`: the planes of the guides are written.
__kernel void guide_gradient(__constant DenoiseParams* p, __global const float* planes, __global const float4* cells, __global const float4* gradients,
                             __global const float4* splatted, __global const float4* upstream, __global float* output_gradient,
                             __global float4* image_gradient) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1), n = (int)get_global_id(2), outputs = 2 * p->levels - 1;
    if (x >= p->width || y >= p->height) return;
    size_t images = get_global_size(2), pixels = (size_t)p->width * (size_t)p->height;
    size_t pixel = (size_t)n * pixels + (size_t)(y * p->width + x), at = (size_t)(y * p->row + x);
    float4 colour = splatted[pixel], to_image = (float4)(0.0f);
    cells += (size_t)n * p->cells, gradients += (size_t)n * p->cells;

    for (int l = 0; l < p->levels; ++l) {
        __constant const GridLevel* level = p->level + l;
        size_t to = plane_start(p, n, outputs, l) + at;
        float guide = planes[to], sum = 0.0f;
        Neighbours near = neighbours_of(p, level, x, y, guide);
        float4 sliced = slice_grid(level, &near, cells), up = upstream[(size_t)l * images * pixels + pixel];
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                uint column = cell_column(level, &near, j, i);
                float w = near.row.weight[j] * near.column.weight[i];
                for (int k = 0; k < 2; ++k) {
                    float4 cell = cells[column + (uint)near.depth.cell[k]], a = gradients[column + (uint)near.depth.cell[k]];
                    float splat = fma(-a.w, colour.w, inner(a, colour)), slice = cell.w > 0.0f ? inner(up, cell - sliced) : 0.0f;
                    sum = fma(w * near.depth.slope[k], splat + slice, sum);
#if CLVR_IMAGE_GRADIENT
                    to_image = fma((float4)(w * near.depth.weight[k]), (float4)(a.x, a.y, a.z, -a.w), to_image);
#endif
                }
            }
        output_gradient[to] = sum * level->slope * (guide * (1.0f - guide));
    }
    if (CLVR_IMAGE_GRADIENT) image_gradient[pixel] = to_image;
}
