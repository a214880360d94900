// What blend_by_variance.cl needs of the pixels around a pixel, summed over 21 columns. With d = noisy - out and v the input's variance, e = d^2 - v shows
// bias: without bias its mean is 0.
#include "shared/denoise_params.h"

// Planes of `size` floats by number, each [rows][width] of one colour; sums: [rows][width] of (e, e^2, v, 0), over fewer columns at the picture's sides.
__kernel void blend_sums(__global const float* planes, uint size, uint noisy, uint variance, uint out, int width, int rows, __global float4* sums) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= rows) return;
    float4 sum = (float4)(0.0f);
    for (int i = x < CLVR_BLEND_RADIUS ? 0 : x - CLVR_BLEND_RADIUS; i <= x + CLVR_BLEND_RADIUS && i < width; ++i) {
        size_t at = (size_t)y * (size_t)width + (size_t)i, n = size;
        float d = planes[noisy * n + at] - planes[out * n + at], v = planes[variance * n + at], e = fma(d, d, -v);
        sum.x += e, sum.y = fma(e, e, sum.y), sum.z += v;
    }
    sums[(size_t)y * (size_t)width + (size_t)x] = sum;
}
