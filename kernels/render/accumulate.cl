// Adds a wave's samples to the pixels' running means and sums of squared deviations, in sample order (Welford 1962). One work-item a pixel.
#pragma OPENCL FP_CONTRACT OFF

// mean: RGB, alpha; deviation: sum of squared deviations of RGB, 0. `before` samples are in them already.
__kernel void accumulate(__global const float4* radiance, __global float4* mean, __global float4* deviation, uint pixels, uint samples, uint before) {
    uint pixel = (uint)get_global_id(0);
    if (pixel >= pixels) return;
    float4 m = mean[pixel], d = deviation[pixel];
    for (uint s = 0; s < samples; ++s) {
        float4 x = radiance[pixel * samples + s];
        float4 before_mean = x - m;
        m += before_mean / (float)(before + s + 1u);
        d = fma(before_mean, x - m, d);
    }
    mean[pixel] = m;
    deviation[pixel] = d;
}
