// Back towards the noisy input where that has converged: what the denoiser changed beyond the input's own noise is its bias. With the sums of blend_sums over a
// window of 21x21 pixels, bias^2 = max(0, sum e - 1.5 sqrt(sum e^2)), what exceeds 1.5 times its standard error; the share bias^2 / (bias^2 + sum w v) of each
// band comes back, the shrinkage with the least mean squared error (the positive-part James-Stein form). What was tried: datasets/results/blend.md.
#include "shared/denoise_params.h"

static float share_of(float4 sum) {
    float bias = fma(-1.5f, sqrt(sum.y), sum.x);
    bias = bias > 0.0f ? bias : 0.0f;
    float total = bias + sum.z;
    return total > 0.0f ? bias / total : 0.0f;
}

// `bands`, `sums`: [rows][width], the plane's rows from `low` on; where they end, windows are smaller. Rows `first` .. `first` + `count` - 1 of them go to
// `result`, which has the plane's rows.
__kernel void blend_by_variance(__global const float4* bands, __global const float* planes, uint size, uint out_plane, __global const float8* sums, int width,
                                int low, int rows, int first, int count, __global float* result) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= count) return;
    float8 sum = (float8)(0.0f);
    int row = first + y;
    for (int j = row < CLVR_BLEND_RADIUS ? 0 : row - CLVR_BLEND_RADIUS; j <= row + CLVR_BLEND_RADIUS && j < rows; ++j) sum += sums[j * width + x];
    float4 band = bands[row * width + x];
    size_t at = (size_t)(low + row) * (size_t)width + (size_t)x;
    float blended = fma(band.x, share_of(sum.lo), fma(band.z, share_of(sum.hi), planes[out_plane * (size_t)size + at]));
    result[at] = blended > 0.0f ? blended : 0.0f;
}
