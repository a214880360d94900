// GuideNet's output (kernels/denoise/README.md, "Network"), CLVR_WIDTH pixels at once: convolution of the hidden layer, then the sigmoid. It gives a guide for
// each level, then the blending weights.
#include "lib/activation.clh"
#include "lib/convolution.clh"

#define SIGMOID(sum, at) v_sigmoid(sum)

// `p` is a band of the picture `q`, whose row `shift` is the band's first; of it the rows from `first` to before `end` are wanted.
__kernel void guides(__constant DenoiseParams* p, __global const float* in, __global const float* weights, __global const float* bias, __global float* out,
                     __constant DenoiseParams* q, int shift, int first, int end) {
    CONVOLVE_ROWS(p, in, weights, bias, first, end, q, shift, out, SIGMOID)
}
