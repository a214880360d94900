// The gradient of the loss by a convolution's weights (kernels/denoise/README.md, "Backward"), for each image, in 16 lanes: lane l sums columns l, l + 16, ...
// of all rows, and train/sum_lanes.cl adds the lanes. A work-item takes CLVR_WIDTH lanes of CLVR_BLOCK output channels, one input channel and one row of the kernel.
#include "lib/planes.clh"
#include "lib/vec.clh"

#ifndef CLVR_IN
#define CLVR_IN 10
#endif
#ifndef CLVR_OUT
#define CLVR_OUT 20
#endif
#ifndef CLVR_KERNEL
#define CLVR_KERNEL 5
#endif
#ifndef CLVR_BLOCK // divides CLVR_OUT
#define CLVR_BLOCK 4
#endif

// `in`: what was convolved, `gradient`: dL/d(sums). `lanes`: [images][parameters][16], the weights from parameter `first` on, OIHW.
// Global: x = 16 / CLVR_WIDTH, y = CLVR_OUT / CLVR_BLOCK * CLVR_IN * CLVR_KERNEL, z = images.
__kernel void weight_gradient(__constant DenoiseParams* p, __global const float* in, __global const float* gradient, __global float* lanes, uint parameters,
                              uint first) {
    int lane = (int)get_global_id(0) * CLVR_WIDTH, job = (int)get_global_id(1), n = (int)get_global_id(2);
    if (lane >= 16 || job >= CLVR_OUT / CLVR_BLOCK * CLVR_IN * CLVR_KERNEL) return;
    int ky = job % CLVR_KERNEL, channel = job / CLVR_KERNEL % CLVR_IN, block = job / CLVR_KERNEL / CLVR_IN * CLVR_BLOCK;
    in += plane_start(p, n, CLVR_IN, channel) + (size_t)((ky - p->pad) * p->row + lane - p->pad);
    gradient += plane_start(p, n, CLVR_OUT, block) + (size_t)lane;

    vfloat sum[CLVR_BLOCK][CLVR_KERNEL];
#pragma unroll
    for (int c = 0; c < CLVR_BLOCK; ++c)
#pragma unroll
        for (int k = 0; k < CLVR_KERNEL; ++k) sum[c][k] = (vfloat)(0.0f);
    for (int y = 0; y < p->height; ++y, in += p->row, gradient += p->row) {
#if CLVR_WIDTH == 1
#pragma unroll 4 // loads of several steps wait together
#else
#pragma nounroll
#endif
        for (int x = 0; x < p->width - lane; x += 16) {
            vfloat v[CLVR_KERNEL];
#pragma unroll
            for (int k = 0; k < CLVR_KERNEL; ++k) v[k] = v_load(in + x + k);
#pragma unroll
            for (int c = 0; c < CLVR_BLOCK; ++c) {
                vfloat g = v_load(gradient + (size_t)c * (size_t)p->plane + x);
#pragma unroll
                for (int k = 0; k < CLVR_KERNEL; ++k) sum[c][k] = fma(g, v[k], sum[c][k]);
            }
        }
    }
    for (int c = 0; c < CLVR_BLOCK; ++c)
        for (int k = 0; k < CLVR_KERNEL; ++k) {
            uint parameter = first + (uint)((((block + c) * CLVR_IN + channel) * CLVR_KERNEL + ky) * CLVR_KERNEL + k);
            v_store(sum[c][k], lanes + ((size_t)n * parameters + parameter) * 16 + (size_t)lane);
        }
}
