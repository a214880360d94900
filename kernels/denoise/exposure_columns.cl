// Luminance and opacity of a picture, summed over the columns of blocks of CLVR_BLOCK rows; block_sums.cl makes blocks of them (kernels/denoise/README.md,
// "Switches"). A work-item takes CLVR_WIDTH columns of a row of blocks.
#include "lib/plane_rows.clh"

#ifndef CLVR_BLOCK
#define CLVR_BLOCK 16
#endif

// `planes` of width * height floats, finite; `colour`: the first of R G B; `opacity`: -1: 1 everywhere. sums: [rows of blocks][luminance, opacity][width].
__kernel void exposure_columns(__global const float* planes, int width, int height, uint colour, int opacity, __global float* sums) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, block = (int)get_global_id(1), y = block * CLVR_BLOCK, left = width - x;
    if (x >= width || y >= height) return;
    size_t size = (size_t)width * (size_t)height;
    int end = y + CLVR_BLOCK < height ? y + CLVR_BLOCK : height;
    vfloat luminance = (vfloat)(0.0f), covered = (vfloat)(0.0f);
    for (; y < end; ++y) {
        __global const float* at = planes + (size_t)y * (size_t)width + (size_t)x;
        vfloat r = row_pixels(at + colour * size, left), g = row_pixels(at + (colour + 1u) * size, left), b = row_pixels(at + (colour + 2u) * size, left);
        luminance += v_max(fma(r, (vfloat)(0.2126f), fma(g, (vfloat)(0.7152f), fma(b, (vfloat)(0.0722f), (vfloat)(0.0f)))), (vfloat)(0.0f));
        covered += opacity < 0 ? (vfloat)(1.0f) : row_pixels(at + (size_t)opacity * size, left);
    }
    __global float* to = sums + (size_t)(2 * block) * (size_t)width + (size_t)x;
    store_row(to, left, luminance);
    store_row(to + width, left, covered);
}
