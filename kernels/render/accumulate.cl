// Adds a wave's samples to the pixels' running means and sums of squared deviations, in sample order (Welford 1962). One work-item a pixel.
#pragma OPENCL FP_CONTRACT OFF

// mean: RGB, alpha; deviation: sum of squared deviations of RGB, 0; of `pixels` pixels from `first` on. `before` samples are in the old ones. The new ones
// may be the same buffers.
__kernel void accumulate(__global const float4* radiance, __global const float4* old_mean, __global const float4* old_deviation, __global float4* mean,
                         __global float4* deviation, uint first, uint pixels, uint samples, uint before) {
    uint pixel = (uint)get_global_id(0), at = first + pixel;
    if (pixel >= pixels) return;
    float4 m = old_mean[at], d = old_deviation[at];
    for (uint s = 0; s < samples; ++s) {
        float4 x = radiance[pixel * samples + s];
        float4 before_mean = x - m;
        m += before_mean / (float)(before + s + 1u);
        d = fma(before_mean, x - m, d);
    }
    mean[at] = m;
    deviation[at] = d;
}
