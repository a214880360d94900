// Splats pixels into a bilateral grid with tent weights, the tent filter with it (SPEC.md sections 5 and 12). A work-item gathers CLVR_BINS cells of one
// grid column from the four blocks of pixels around it, in the order 00 01 10 11, each by rows: the same sums for every shape, no atomics. On PoCL
// a whole column at once is fastest, on GPUs a cell a work-item. Global: x = columns, y = rows, z = images * ceil(depth / CLVR_BINS).
#pragma OPENCL FP_CONTRACT OFF
#include "shared/denoise_params.h"
#include "lib/grid.clh"

#ifndef CLVR_BINS
#define CLVR_BINS 64
#endif
#ifndef CLVR_SUMS // 1: store the sums N and D; 0: the mean N / D and D
#define CLVR_SUMS 0
#endif

// Colours (xyz) and weights (w) of the pixels go where plane `level_number` of the `planes` guides says. Image n's pixels are image first + n of
// `splatted`.
__kernel void splat(__constant DenoiseParams* p, int level_number, int planes, __global const float* guides, __global const float4* splatted,
                    int first_image, __global float4* cells) {
    __constant const GridLevel* level = p->level + level_number;
    int column = (int)get_global_id(0), row = (int)get_global_id(1), runs = (level->depth + CLVR_BINS - 1) / CLVR_BINS;
    int n = (int)get_global_id(2) / runs, first = (int)get_global_id(2) % runs * CLVR_BINS;
    if (column >= level->columns || row >= level->rows) return;
    guides += plane_start(p, n, planes, level_number);
    splatted += (size_t)(first_image + n) * (size_t)(p->width * p->height);

    float4 sum[CLVR_BINS];
    for (int k = 0; k < CLVR_BINS; ++k) sum[k] = (float4)(0.0f);
    int cell = level->pixels, half_cell = cell / 2;
    for (int quarter = 0; quarter < 4; ++quarter) {
        // The pixels between the centres of cell rows `above` and above + 1, cell columns `left` and left + 1.
        int above = row - 1 + quarter / 2, left = column - 1 + quarter % 2;
        int y0 = above * cell + half_cell, y1 = y0 + cell, x0 = left * cell + half_cell, x1 = x0 + cell;
        y0 = y0 > 0 ? y0 : 0, y1 = y1 < p->height ? y1 : p->height;
        x0 = x0 > 0 ? x0 : 0, x1 = x1 < p->width ? x1 : p->width;
        for (int y = y0; y < y1; ++y) {
            float ty = tent_of_pixel(y, cell).t, wy = above < row ? ty : 1.0f - ty;
            for (int x = x0; x < x1; ++x) {
                float tx = tent_of_pixel(x, cell).t, w = wy * (left < column ? tx : 1.0f - tx);
                Tent depth = tent_of_guide(p, level, guides[y * p->row + x]);
                float4 colour = splatted[y * p->width + x];
                int lower = depth.lower - first;
                if (lower >= 0 && lower < CLVR_BINS) sum[lower] = fma((float4)(w * (1.0f - depth.t)), colour, sum[lower]);
                if (lower >= -1 && lower + 1 < CLVR_BINS) sum[lower + 1] = fma((float4)(w * depth.t), colour, sum[lower + 1]);
            }
        }
    }

    cells += (size_t)n * p->cells + level->offset + (size_t)((row * level->columns + column) * level->depth + first);
    for (int k = 0; k < CLVR_BINS && first + k < level->depth; ++k) {
        float4 total = sum[k];
#if !CLVR_SUMS
        float4 mean = total / (total.w > 0.0f ? total.w : 1.0f);
        total = total.w > 0.0f ? (float4)(mean.x, mean.y, mean.z, total.w) : (float4)(0.0f);
#endif
        cells[k] = total;
    }
}
