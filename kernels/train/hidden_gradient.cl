// How the loss changes with the hidden layer's sums: dL/dp1 from dL/dp2 (kernels/denoise/README.md, "Backward"), CLVR_WIDTH pixels at once: a convolution
// with the mirrored, transposed weights, times the slope of the leaky ReLU.
#include "lib/activation.clh"
#include "lib/convolution.clh"

#define SLOPED(sum, at) v_leaky_gradient(sum, v_load(activated + (at)))

__kernel void hidden_gradient(__constant DenoiseParams* p, __global const float* in, __global const float* weights, __global const float* bias,
                              __global float* out, __global const float* activated) {
    CONVOLVE(p, in, weights, bias, out, SLOPED)
}
