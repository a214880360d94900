// Planes of an image as the matrix that turns a convolution into a matrix product ("im2col"): row (channel, ky, kx), column pixel.
#include "lib/planes.clh"

#ifndef CLVR_KERNEL // 1: the planes without their borders
#define CLVR_KERNEL 5
#endif
#define CLVR_TAPS (CLVR_KERNEL * CLVR_KERNEL)

// `matrix`: [channels * CLVR_TAPS][height * width]. Global: width, height, channels * CLVR_TAPS.
__kernel void unfold(__constant DenoiseParams* p, __global const float* planes, int channels, int image, __global float* matrix) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1), line = (int)get_global_id(2);
    if (x >= p->width || y >= p->height || line >= channels * CLVR_TAPS) return;
    int tap = line % CLVR_TAPS, ky = tap / CLVR_KERNEL - CLVR_KERNEL / 2, kx = tap % CLVR_KERNEL - CLVR_KERNEL / 2;
    size_t from = plane_start(p, image, channels, line / CLVR_TAPS) + (size_t)((y + ky) * p->row + x + kx);
    matrix[((size_t)line * (size_t)p->height + (size_t)y) * (size_t)p->width + (size_t)x] = planes[from];
}
