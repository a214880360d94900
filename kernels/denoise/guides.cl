// GuideNet's output, CLVR_WIDTH pixels at once: convolution of the hidden layer, then the sigmoid: a guide a level, then the blending weights (SPEC.md section 3).
#include "lib/convolution.clh"

#define SIGMOID(sum, at) v_sigmoid(sum)

// 1 / (1 + e^-x), as v_exp but without its care for what underflows: x beyond +-87 counts as that.
static inline vfloat v_sigmoid(vfloat x) {
    x = v_clamp(x, (vfloat)(-87.0f), (vfloat)(87.0f));
    vfloat n = floor(fma(x, (vfloat)(-1.44269504f), (vfloat)(0.5f)));
    vfloat r = fma(n, (vfloat)(2.12194440e-4f), fma(n, (vfloat)(-0.693359375f), -x));
    vfloat p = (vfloat)(0.00139529549f);
    p = fma(p, r, (vfloat)(0.00837031472f));
    p = fma(p, r, (vfloat)(0.0416661687f));
    p = fma(p, r, (vfloat)(0.166665062f));
    p = fma(p, r, (vfloat)(0.5f));
    p = fma(p * r, r, r);
    vfloat y = v_as_float(v_as_int(1.0f + p) + (v_int(n) << 23)); // 2^n (1 + p)
    return 1.0f / (1.0f + y);
}

__kernel void guides(__constant DenoiseParams* p, __global const float* in, __global const float* weights, __global const float* bias, __global float* out) {
    CONVOLVE(p, in, weights, bias, out, SIGMOID)
}
