// Takes the result back towards the noisy input where that has converged: a change by the denoiser beyond the input's own noise is its bias. With the sums of
// blend_sums.cl over a window of 21x21 pixels, bias^2 = max(0, sum e - 2 sqrt(sum e^2)), what exceeds twice its standard error; result = out + d bias^2 /
// (bias^2 + sum v), the shrinkage with the least mean squared error (the positive-part James-Stein form). The variance of few samples is itself noisy: over
// 7x7 pixels, with 1.5 times the variance in place of the standard error, bonsai at 2 samples per pixel lost 0.6 dB; now 2 samples lose nothing, and 64 gain
// 1 dB over the network alone. With n/(n-1) times the variance in its place few samples do as well and 64 gain a further 0.1 to 0.5 dB, but at 4 samples ten
// times as many pixels get noise back.
#include "shared/denoise_params.h"

// `sums`: [rows][width] of blend_sums; planes of `size` floats by number, `noisy` and `out`: [rows][width], which is taken back in place. Where the rows end,
// windows are smaller.
__kernel void blend_by_variance(__global float* planes, uint size, uint noisy, uint out, __global const float4* sums, int width, int rows) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= rows) return;
    float4 sum = (float4)(0.0f);
    for (int j = y < CLVR_BLEND_RADIUS ? 0 : y - CLVR_BLEND_RADIUS; j <= y + CLVR_BLEND_RADIUS && j < rows; ++j) sum += sums[(size_t)j * (size_t)width + (size_t)x];
    size_t at = (size_t)y * (size_t)width + (size_t)x, n = size;
    float bias = fma(-2.0f, sqrt(sum.y), sum.x), result = planes[out * n + at];
    bias = bias > 0.0f ? bias : 0.0f;
    float total = bias + sum.z;
    float share = total > 0.0f ? bias / total : 0.0f;
    planes[out * n + at] = fma(planes[noisy * n + at] - result, share, result);
}
