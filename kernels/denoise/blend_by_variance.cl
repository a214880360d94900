// Back towards the noisy input where that has converged: what the denoiser changed beyond the input's own noise is its bias. With d = noisy - out, over a
// 7x7 window, bias^2 = max(0, mean d^2 - 2 mean variance), result = out + d bias^2 / (bias^2 + mean variance): the shrinkage with the least mean squared
// error (the positive-part James-Stein form).
#define RADIUS 3

// `noisy`, `variance`, `out`: [rows][width] of one colour, the window's rows included: those of the result begin at `first`. Beyond the picture's sides
// windows are smaller, and above and below where the rows end.
__kernel void blend_by_variance(__global const float* noisy, __global const float* variance, __global const float* out, int width, int rows, int first, int count,
                                __global float* result) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= count) return;
    float squares = 0.0f, variances = 0.0f;
    for (int j = -RADIUS; j <= RADIUS; ++j)
        for (int i = -RADIUS; i <= RADIUS; ++i) {
            int column = x + i, row = first + y + j;
            if (column < 0 || column >= width || row < 0 || row >= rows) continue;
            int at = row * width + column;
            float d = noisy[at] - out[at];
            squares = fma(d, d, squares);
            variances += variance[at];
        }
    int at = (first + y) * width + x;
    float bias = fma(-2.0f, variances, squares);
    bias = bias > 0.0f ? bias : 0.0f;
    float total = bias + variances;
    float share = total > 0.0f ? bias / total : 0.0f;
    result[y * width + x] = fma(noisy[at] - out[at], share, out[at]);
}
