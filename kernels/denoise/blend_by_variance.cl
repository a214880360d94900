// Takes the result back towards the noisy input where that has converged: a change by the denoiser beyond the input's own noise is its bias. With the sums of
// blend_sums.cl over a window of 21x21 pixels, bias^2 = max(0, sum e - 2 sqrt(sum e^2)), what exceeds twice its standard error; result = out + d bias^2 /
// (bias^2 + sum v), the shrinkage with the least mean squared error (the positive-part James-Stein form). The variance of few samples is itself noisy: over
// 7x7 pixels, with 1.5 times the variance in place of the standard error, bonsai at 2 samples per pixel lost 0.6 dB; now 2 samples lose nothing, and 64 gain
// 1 dB over the network alone. With n/(n-1) times the variance in its place few samples do as well and 64 gain a further 0.1 to 0.5 dB, but at 4 samples ten
// times as many pixels get noise back.
#include "shared/denoise_params.h"

// `sums`: [rows][width] of blend_sums; `noisy`, `out`: [rows][width]. The rows of the result begin at `first`; where the rows end, windows are smaller.
__kernel void blend_by_variance(__global const float* noisy, __global const float* out, __global const float4* sums, int width, int rows, int first, int count,
                                __global float* result) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= count) return;
    float4 sum = (float4)(0.0f);
    int row = first + y;
    for (int j = row < CLVR_BLEND_RADIUS ? 0 : row - CLVR_BLEND_RADIUS; j <= row + CLVR_BLEND_RADIUS && j < rows; ++j) sum += sums[j * width + x];
    int at = row * width + x;
    float bias = fma(-2.0f, sqrt(sum.y), sum.x);
    bias = bias > 0.0f ? bias : 0.0f;
    float total = bias + sum.z;
    float share = total > 0.0f ? bias / total : 0.0f;
    result[y * width + x] = fma(noisy[at] - out[at], share, out[at]);
}
