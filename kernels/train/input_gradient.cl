// How the loss changes with the network's input: dL/d(input) from dL/dp1 (kernels/denoise/README.md, "Backward"), CLVR_WIDTH pixels at once: a convolution with the
// mirrored, transposed weights.
#include "lib/convolution.clh"

#define PLAIN(sum, at) (sum)

__kernel void input_gradient(__constant DenoiseParams* p, __global const float* in, __global const float* weights, __global const float* bias,
                             __global float* out) {
    CONVOLVE(p, in, weights, bias, out, PLAIN)
}
