// A convolution's matrix product as planes: bias and activation as in denoise/hidden.cl (0), denoise/guides.cl (1), train/hidden_gradient.cl (2).
#include "lib/activation.clh"
#include "lib/planes.clh"

#ifndef CLVR_ACTIVATION
#define CLVR_ACTIVATION 0
#endif

// `product`: [channels][height * width]. `biases`: of the channels, from parameter `first_bias` on. `activated`: the hidden layer (2 alone).
// Global: width, height, channels.
__kernel void activate(__constant DenoiseParams* p, __global const float* product, __global const float* parameters, uint first_bias, int channels,
                       int image, __global float* planes, __global const float* activated) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1), channel = (int)get_global_id(2);
    if (x >= p->width || y >= p->height || channel >= channels) return;
    float sum = product[((size_t)channel * (size_t)p->height + (size_t)y) * (size_t)p->width + (size_t)x];
    size_t at = plane_start(p, image, channels, channel) + (size_t)(y * p->row + x);
#if CLVR_ACTIVATION == 0
    planes[at] = v_leaky(sum + parameters[first_bias + (uint)channel]);
#elif CLVR_ACTIVATION == 1
    planes[at] = v_sigmoid(sum + parameters[first_bias + (uint)channel]);
#else
    planes[at] = v_leaky_gradient(sum, activated[at]);
#endif
}
