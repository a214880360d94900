// What blend_by_variance needs of the pixels beside a pixel, summed over 21 columns. With b a band of blend_bands and v its variance, e = w (b^2 - v) is a pixel's
// sign of bias: without bias its mean is 0. w = 1 / (out + 0.01) weighs as eyes and the training's loss do: bright pixels alone do not decide.
#include "shared/denoise_params.h"

// sums: [rows][width] of (e, e^2, w v, 0) of the low band, then of the rest, over fewer columns at the picture's sides.
__kernel void blend_sums(__global const float4* bands, __global const float* weights, int width, int rows, __global float8* sums) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= rows) return;
    float4 low = (float4)(0.0f), rest = low;
    for (int i = x < CLVR_BLEND_RADIUS ? 0 : x - CLVR_BLEND_RADIUS; i <= x + CLVR_BLEND_RADIUS && i < width; ++i) {
        float4 b = bands[y * width + i];
        float weight = weights[y * width + i], over = fma(b.x, b.x, -b.y), rest_over = fma(b.z, b.z, -b.w);
        float e = weight * over, rest_e = weight * rest_over;
        low = (float4)(fma(weight, over, low.x), fma(e, e, low.y), fma(weight, b.y, low.z), 0.0f);
        rest = (float4)(fma(weight, rest_over, rest.x), fma(rest_e, rest_e, rest.y), fma(weight, b.w, rest.z), 0.0f);
    }
    sums[y * width + x] = (float8)(low, rest);
}
