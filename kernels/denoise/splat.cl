// Splats pixels into a bilateral grid with tent weights, which are its filter, too (kernels/denoise/README.md, "Splat"). A work-item gathers CLVR_BINS cells of one
// grid column from the four blocks of pixels around it, in the order 00 01 10 11, each by rows: the same sums for every shape, no atomics. Cells
// and weights are found for CLVR_WIDTH pixels at once. On PoCL a whole column a work-item is fastest, on an H100 eight cells (1.7 x as fast as one): neighbouring
// work-items then read the same pixels and write neighbouring cells. Global: x = columns * ceil(depth / CLVR_BINS), y = rows, z = images.
#include "lib/grid.clh"

#ifndef CLVR_BINS
#define CLVR_BINS 64
#endif
#ifndef CLVR_WHOLE // 1: CLVR_BINS is the depth
#define CLVR_WHOLE 1
#endif
#ifndef CLVR_SUMS // 1: store the sums N and D; 0: the mean N / D and D
#define CLVR_SUMS 0
#endif

// Colours (xyz) and weights (w) of the pixels go where plane `level_number` of the `planes` guides says. Image n's pixels are image first_image + n of
// `splatted`.
__kernel void splat(__constant DenoiseParams* p, int level_number, int planes, __global const float* guides, __global const float4* splatted,
                    int first_image, __global float4* cells) {
    __constant const GridLevel* level = p->level + level_number;
    int row = (int)get_global_id(1), n = (int)get_global_id(2), runs = (level->depth + CLVR_BINS - 1) / CLVR_BINS;
    int column = (int)get_global_id(0) / runs, first = (int)get_global_id(0) % runs * CLVR_BINS;
    if (column >= level->columns || row >= level->rows) return;
    guides += plane_start(p, n, planes, level_number);
    splatted += (size_t)(first_image + n) * (size_t)(p->width * p->height);

    float4 sums[CLVR_BINS + 2], *sum = sums + 1; // one cell more at either end, for weights that are dropped
    for (int k = 0; k < CLVR_BINS + 2; ++k) sums[k] = (float4)(0.0f);
    int cell = level->pixels, half_cell = cell / 2;
    for (int quarter = 0; quarter < 4; ++quarter) {
        // The pixels between the centres of cell rows `above` and above + 1, cell columns `left` and left + 1.
        int above = row - 1 + quarter / 2, left = column - 1 + quarter % 2;
        int y0 = above * cell + half_cell, y1 = y0 + cell, x0 = left * cell + half_cell, x1 = x0 + cell;
        y0 = y0 > 0 ? y0 : 0, y1 = y1 < p->height ? y1 : p->height;
        x0 = x0 > 0 ? x0 : 0, x1 = x1 < p->width ? x1 : p->width;
        for (int y = y0; y < y1; ++y) {
            Tent ty = tent_of_pixel(level, (vint)(y));
            vfloat wy = above < row ? ty.t : ty.rest;
            for (int x = x0; x < x1; x += CLVR_WIDTH) {
                Tent tx = tent_of_pixel(level, (vint)(x) + v_iota);
                vfloat w = wy * (left < column ? tx.t : tx.rest);
                Tent depth = tent_of_guide(p, level, v_load(guides + y * p->row + x));
                int to[CLVR_WIDTH];
                float lower[CLVR_WIDTH], upper[CLVR_WIDTH];
                v_store(depth.lower - first, to), v_store(w * depth.rest, lower), v_store(w * depth.t, upper);
                for (int i = 0; i < CLVR_WIDTH && x + i < x1; ++i) {
                    if (!CLVR_WHOLE && (to[i] < -1 || to[i] >= CLVR_BINS)) continue;
                    float4 colour = splatted[y * p->width + x + i];
                    sum[to[i]] = fma((float4)(lower[i]), colour, sum[to[i]]);
                    sum[to[i] + 1] = fma((float4)(upper[i]), colour, sum[to[i] + 1]);
                }
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
