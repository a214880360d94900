// Gives light back to pixels whose feature rays missed what the paths met: structures thinner than a pixel, where opacity.A is 0 or nearly so and the
// result with it. Of the difference d to the input the share 1 - 4 v / d^2 comes back, v the input's variance (the positive-part James-Stein form, at two
// standard errors): nothing at few samples, all where it has converged; less the more the feature rays saw, nothing from a quarter on, one of four. Alpha and
// the colours take the same share. One work-item a pixel.
#pragma OPENCL FP_CONTRACT OFF

// Planes of `size` floats, by number: `out`, `noisy`: the first of R G B A; `variance`: of R G B; `opacity`: what the feature rays saw.
__kernel void give_back(__global float* planes, uint size, uint out, uint noisy, uint variance, uint opacity) {
    size_t i = get_global_id(0), n = size;
    if (i >= n) return;
    float missed = fma(-4.0f, planes[opacity * n + i], 1.0f);
    if (!(missed > 0.0f) || !(planes[(noisy + 3u) * n + i] > 0.0f)) return;
    float apart = 0.0f, noise = 0.0f, d[4];
    for (uint c = 0; c < 4u; ++c) d[c] = planes[(noisy + c) * n + i] - planes[(out + c) * n + i];
    for (uint c = 0; c < 3u; ++c) apart = fma(d[c], d[c], apart), noise += planes[(variance + c) * n + i];
    float share = apart > 0.0f ? missed * fma(-4.0f, noise / apart, 1.0f) : 0.0f;
    if (!(share > 0.0f)) return;
    for (uint c = 0; c < 4u; ++c) planes[(out + c) * n + i] = fma(share, d[c], planes[(out + c) * n + i]);
}
