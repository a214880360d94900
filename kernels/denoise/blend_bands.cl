// Two bands of what the denoiser changed, d = noisy - out: low = out sum k d / sum k out, its mean over 3x3 pixels as a share of the picture there (so that it stops
// at silhouettes: k d alone spills into what is dark, and cost 0.4 to 1.1 dB), and the rest, d - low. k = 1 2 1 both ways, 1/16.
#include "shared/denoise_params.h"

// Planes of `size` floats by number, of one colour, their rows `low` .. `low` + `rows` - 1; `out` not below 0. `noise`: the true variance per given one. bands: [rows][width] of (low, its variance,
// rest, its variance), of independent pixels; weights: [rows][width], 1 / (out + 0.01). Beyond the rows is nothing.
__kernel void blend_bands(__global const float* planes, uint size, uint noisy_plane, uint variance_plane, uint out_plane, float noise, int width, int low,
                          int rows, __global float4* bands, __global float* weights) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= width || y >= rows) return;
    size_t n = size, start = (size_t)low * (size_t)width;
    __global const float *noisy = planes + noisy_plane * n + start, *variance = planes + variance_plane * n + start, *out = planes + out_plane * n + start;
    float whole = 0.0f, change = 0.0f, spread = 0.0f;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            if (x + i < 0 || x + i >= width || y + j < 0 || y + j >= rows) continue;
            int at = (y + j) * width + x + i;
            float k = (i == 0 ? 2.0f : 1.0f) * (j == 0 ? 0.125f : 0.0625f);
            whole = fma(k, out[at], whole);
            change = fma(k, noisy[at] - out[at], change);
            spread = fma(k * k, variance[at], spread);
        }
    int at = y * width + x;
    float share = whole > 0.0f ? out[at] / whole : 0.0f, v = noise * variance[at], of_spread = noise * share * share;
    float rest_v = fma(of_spread, spread, fma(-0.5f * share, v, v));
    weights[at] = 1.0f / (out[at] + 0.01f);
    bands[at] = (float4)(share * change, of_spread * spread, fma(-share, change, noisy[at] - out[at]), rest_v > 0.0f ? rest_v : 0.0f);
}
