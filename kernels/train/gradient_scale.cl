// The factor that brings a gradient's L2 norm down to `greatest` (1 where it is below). One work-item, a sum in order.
#pragma OPENCL FP_CONTRACT OFF

__kernel void gradient_scale(__global const float* gradient, uint count, float greatest, __global float* scale) {
    float sum = 0.0f;
    for (uint i = 0; i < count; ++i) sum = fma(gradient[i], gradient[i], sum);
    float norm = sqrt(sum);
    scale[0] = norm > greatest ? greatest / norm : 1.0f;
}
