// What blend_by_variance.cl needs of the pixels around a pixel, summed over 21 columns. With d = noisy - out and v the input's variance, e = d^2 - v shows
// bias: without bias its mean is 0.
#include "shared/denoise_params.h"

// `noisy`, `variance`, `out`: [rows][width] of one colour; sums: [rows][width] of (e, e^2, v, 0), over fewer columns at the picture's sides.
__kernel void blend_sums(__global const float* noisy, __global const float* variance, __global const float* out, int width, int rows, __global float4* sums) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= rows) return;
    float4 sum = (float4)(0.0f);
    for (int i = x < CLVR_BLEND_RADIUS ? 0 : x - CLVR_BLEND_RADIUS; i <= x + CLVR_BLEND_RADIUS && i < width; ++i) {
        int at = y * width + i;
        float d = noisy[at] - out[at], v = variance[at], e = fma(d, d, -v);
        sum.x += e, sum.y = fma(e, e, sum.y), sum.z += v;
    }
    sums[y * width + x] = sum;
}
