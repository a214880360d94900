// Back towards the noisy input where that has converged: what the denoiser changed beyond the input's own noise is its bias. With d = noisy - out, over a
// window of 21x21 pixels, bias^2 = max(0, mean d^2 - times * mean variance), result = out + d bias^2 / (bias^2 + mean variance): the shrinkage with the least
// mean squared error (the positive-part James-Stein form). `times` is n/(n-1) of n samples per pixel: a variance of few samples is itself noise, hence the
// window so wide and the caution. With a window of 7x7 and once the variance, 2 samples per pixel lost 0.6 dB; now 2 lose nothing and 64 gain 1.4 dB.
#define RADIUS 10

// `sums`: [rows][width] of blend_sums; `noisy`, `out`: [rows][width]. The rows of the result begin at `first`; where the rows end, windows are smaller.
__kernel void blend_by_variance(__global const float* noisy, __global const float* out, __global const float2* sums, int width, int rows, int first, int count, float times,
                                __global float* result) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= count) return;
    float squares = 0.0f, variances = 0.0f;
    int row = first + y;
    for (int j = row < RADIUS ? 0 : row - RADIUS; j <= row + RADIUS && j < rows; ++j) {
        float2 sum = sums[j * width + x];
        squares += sum.x, variances += sum.y;
    }
    int at = row * width + x;
    float bias = fma(-times, variances, squares);
    bias = bias > 0.0f ? bias : 0.0f;
    float total = bias + variances;
    float share = total > 0.0f ? bias / total : 0.0f;
    result[y * width + x] = fma(noisy[at] - out[at], share, out[at]);
}
