// Puts marched values at their pixels: from planes by pixel number to planes of a film. One work-item a pixel number.
#include "lib/paths.clh"

// `tile`: `channels` planes of `stride` floats, pixel number first + i at i; `planes` of width * height floats.
__kernel void place(__global const float* tile, uint stride, uint channels, uint first, uint count, int width, int height, __global float* planes,
                    uint first_plane) {
    uint i = (uint)get_global_id(0);
    uint2 pixel = pixel_of(first + i, width);
    if (i >= count || pixel.x >= (uint)width || pixel.y >= (uint)height) return;
    size_t size = (size_t)width * (size_t)height;
    __global float* to = planes + first_plane * size + (size_t)pixel.y * (size_t)width + pixel.x;
    for (uint c = 0; c < channels; ++c) to[c * size] = tile[c * stride + i];
}
