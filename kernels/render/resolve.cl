// From the statistics of the pixels' samples to planes of a film: mean R G B A and, from two samples on, the variance of the mean. One work-item a
// pixel number.
#include "lib/paths.clh"

#pragma OPENCL FP_CONTRACT OFF

// mean, deviation: by pixel number, as render/accumulate.cl leaves them. `planes`: R G B A variance.R G B, of width * height values each; the variances
// with `scale` > 0 alone: scale + rest is 1 / (n (n - 1)) in two parts, so that the product is that of doubles rounded once.
__kernel void resolve(__global const float4* mean, __global const float4* deviation, int width, int height, float scale, float rest, __global float* planes,
                      uint first_plane) {
    uint number = (uint)get_global_id(0);
    uint2 pixel = pixel_of(number, width);
    if (pixel.x >= (uint)width || pixel.y >= (uint)height) return;
    size_t size = (size_t)width * (size_t)height;
    __global float* to = planes + first_plane * size + (size_t)pixel.y * (size_t)width + pixel.x;
    float4 m = mean[number];
    to[0] = m.x, to[size] = m.y, to[2 * size] = m.z, to[3 * size] = m.w;
    if (scale > 0.0f) {
        float4 d = deviation[number];
        to[4 * size] = fma(d.x, scale, d.x * rest), to[5 * size] = fma(d.y, scale, d.y * rest), to[6 * size] = fma(d.z, scale, d.z * rest);
    }
}
