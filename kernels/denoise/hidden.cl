// GuideNet's hidden layer, CLVR_WIDTH pixels at once: convolution of the network's input, then leaky ReLU with slope 0.2 (kernels/denoise/README.md, "Network").
#include "lib/activation.clh"
#include "lib/convolution.clh"

#define LEAKY(sum, at) v_leaky(sum)

__kernel void hidden(__constant DenoiseParams* p, __global const float* in, __global const float* weights, __global const float* bias, __global float* out) {
    CONVOLVE(p, in, weights, bias, out, LEAKY)
}
