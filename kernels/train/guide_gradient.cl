// How the loss changes with the guides, through slicing and splatting at once (kernels/denoise/README.md, "Backward"), and from that with the sums before
// their sigmoid. A work-item takes CLVR_WIDTH pixels of a row.
#include "lib/grid.clh"
#include "lib/pixels.clh"

#ifndef CLVR_IMAGE_GRADIENT // 1: also the slope of the loss by the splatted colours (xyz) and weights (w), summed over the levels
#define CLVR_IMAGE_GRADIENT 0
#endif

#ifndef CLVR_SIGMOID // 0: by the guides themselves
#define CLVR_SIGMOID 1
#endif

static inline float inner(float4 a, float4 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }

// dL/d(weight of a pixel in a cell): by splatting its colour and weight, and by slicing. `a`: A and b of the cell.
static inline float toward(float4 cell, float4 a, float4 colour, float4 sliced, float4 up) {
    return fma(-a.w, colour.w, inner(a, colour)) + (cell.w > 0.0f ? inner(up, cell - sliced) : 0.0f);
}

// `gradients`: A (xyz) and b (w) of each cell. `upstream` as slice_gradient writes it. `output_gradient`: the planes of the guides are written.
__kernel void guide_gradient(__constant DenoiseParams* p, __global const float* planes, __global const float4* cells, __global const float4* gradients,
                             __global const float4* splatted, __global const float4* upstream, __global float* output_gradient,
                             __global float4* image_gradient) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1), n = (int)get_global_id(2), outputs = 2 * p->levels - 1;
    if (x >= p->width || y >= p->height) return;
    int images = (int)get_global_size(2), left = p->width - x;
    size_t at = (size_t)(y * p->row + x);
    cells += (size_t)n * p->cells, gradients += (size_t)n * p->cells;
#if CLVR_IMAGE_GRADIENT
    float4 to_image[CLVR_WIDTH];
    for (int i = 0; i < CLVR_WIDTH; ++i) to_image[i] = (float4)(0.0f);
#endif

    for (int l = 0; l < p->levels; ++l) {
        __constant const GridLevel* level = p->level + l;
        size_t to = plane_start(p, n, outputs, l) + at;
        vfloat guide = v_load(planes + to);
        Neighbours near;
        find_neighbours(p, level, x, y, guide, &near);
        Sliced sliced = slice_grid(&near, cells);
        float r[CLVR_WIDTH], g[CLVR_WIDTH], b[CLVR_WIDTH], slope[CLVR_WIDTH];
        v_store(sliced.r, r), v_store(sliced.g, g), v_store(sliced.b, b), v_store((vfloat)(0.0f), slope);
        for (int i = 0; i < CLVR_WIDTH && i < left; ++i) {
            float4 colour = splatted[pixel_number(p, n, x + i, y)], up = upstream[pixel_number(p, l * images + n, x + i, y)];
            float4 mean = (float4)(r[i], g[i], b[i], 0.0f);
            float sum = 0.0f;
#pragma unroll
            for (int k = 0; k < 4; ++k) {
                float8 cell = cell_pair(&near, cells, k, i), a = cell_pair(&near, gradients, k, i);
                float lower = toward(cell.lo, a.lo, colour, mean, up), upper = toward(cell.hi, a.hi, colour, mean, up);
                sum = fma(near.weight[k][i], fma(near.upper_slope[i], upper, near.lower_slope[i] * lower), sum);
#if CLVR_IMAGE_GRADIENT
                float4 share = fma((float4)(near.upper[i]), a.hi, a.lo * near.lower[i]);
                to_image[i] = fma((float4)(near.weight[k][i]), (float4)(share.x, share.y, share.z, -share.w), to_image[i]);
#endif
            }
            slope[i] = sum;
        }
        vfloat by_guide = v_load(slope) * level->slope;
        v_store(CLVR_SIGMOID ? by_guide * (guide * (1.0f - guide)) : by_guide, output_gradient + to);
    }
#if CLVR_IMAGE_GRADIENT
    for (int i = 0; i < CLVR_WIDTH && i < left; ++i) image_gradient[pixel_number(p, n, x + i, y)] = to_image[i];
#else
    (void)image_gradient;
#endif
}
