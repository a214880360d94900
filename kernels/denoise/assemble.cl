// A part of a source image, turned by one of the 8 dihedral transforms, as the network and the grids read it (kernels/denoise/README.md, "Input"): the network's
// input, the colour to splat (demodulated radiance, weight), what the result is multiplied with, target, known light. A work-item takes CLVR_WIDTH pixels of a row.
#include "lib/pixels.clh"
#include "lib/tonemap.clh"

// Pixels of a plane: `at` is the first, the others follow `step` apart; beyond the image's right border the last one again.
static inline vfloat source_pixels(__global const float* plane, int at, int step, int left) {
    if (step == 1 && left >= CLVR_WIDTH) return v_load(plane + at);
    return v_gather(plane, v_min(v_iota, (vint)(left - 1)) * step + at);
}

// `source` holds planes of `size` floats; `channel` is (plane, ChannelKind) per input channel. `from`: where in a plane the part's first pixel lies, its
// steps to the next pixel of a row and of a column (negative or swapped when the part is turned); n, the image of the batch. Radiance is premultiplied. The
// network's input is that of `p`, a band of the picture `q` whose row `shift` is the band's first; all else is written for the picture.
__kernel void assemble(__constant DenoiseParams* p, __constant DenoiseParams* q, int shift, SourceParams s, __global const float* source, uint size, int4 from,
                       __global const int2* channel, __global float* input, __global float4* splatted, __global float4* remodulation, __global float* target,
                       __global float* known) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1), n = from.w;
    if (x >= p->width || y >= p->height) return;
    int at = from.x + x * from.y + y * from.z, left = p->width - x;
    vmask inside = v_lt(v_iota, (vint)(left));
    int row = y + shift;
#define SOURCE(plane) source_pixels(source + (size_t)(plane) * size, at, from.y, left)
#define PLANE(p, planes, channels, c, y, v) \
    v_store(v_select(inside, v, (vfloat)(0.0f)), planes + plane_start(p, n, channels, c) + (size_t)(y * p->row + x))

    for (int c = 0; c < s.channels; ++c) {
        vfloat v = (vfloat)(s.noise);
        if (channel[c].y != CLVR_CHANNEL_NOISE) v = SOURCE(channel[c].x);
        if (channel[c].y == CLVR_CHANNEL_RADIANCE) v = v_tonemap(v_min(v * s.exposure, (vfloat)(s.ceiling)));
        if (channel[c].y == CLVR_CHANNEL_NORMAL) v = fma(v, (vfloat)(0.5f), (vfloat)(0.5f));
        PLANE(p, input, s.channels, c, y, v);
    }

    vfloat weight = (vfloat)(1.0f);
    if (s.opacity >= 0) weight = SOURCE(s.opacity);
    vfloat radiance[3], factor[3];
    for (int k = 0; k < 3; ++k) {
        vfloat albedo = (vfloat)(1.0f);
        if (s.albedo >= 0) albedo = v_max(SOURCE(s.albedo + k), (vfloat)(s.albedo_floor));
        radiance[k] = v_min(SOURCE(s.beauty + k) * s.exposure, (vfloat)(s.ceiling));
        if (s.known >= 0) {
            vfloat light = v_min(SOURCE(s.known + k) * s.exposure, (vfloat)(s.ceiling));
            PLANE(q, known, 3, k, row, light);
            radiance[k] -= light;
        }
        radiance[k] /= albedo;
        factor[k] = albedo * weight;
        if (s.target >= 0) PLANE(q, target, 3, k, row, SOURCE(s.target + k) * s.exposure);
    }
    Colours colours = {radiance[0], radiance[1], radiance[2], weight}, factors = {factor[0], factor[1], factor[2], (vfloat)(0.0f)};
    store_colours(q, splatted, n, x, row, colours);
    store_colours(q, remodulation, n, x, row, factors);
}
