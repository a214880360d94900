// A part of a source image, turned by one of the 8 dihedral transforms, as the network and the grids read it: network input (SPEC.md section 2),
// colour to splat (demodulated radiance, weight), what multiplies the result again, target. One work-item a pixel of image `n` of the batch.
#include "shared/denoise_params.h"
#include "lib/planes.clh"
#include "lib/tonemap.clh"

// `source` holds the planes, `extent` columns by rows; `channel` is (plane, ChannelKind) per input channel. `from`: the part's left column and top row,
// its orientation (0..3: quarter turns counter-clockwise, 4..7: those, then upside down), n. Radiance is premultiplied.
__kernel void assemble(__constant DenoiseParams* p, __constant SourceParams* s, __global const float* source, int2 extent, int4 from,
                       __global const int2* channel, __global float* input, __global float4* splatted, __global float4* remodulation, __global float* target) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1), n = from.w;
    if (x >= p->width || y >= p->height) return;
    int row = from.z < 4 ? y : p->height - 1 - y, column = x, rows = p->height, columns = p->width;
    for (int turn = from.z & 3; turn > 0; --turn) {
        int above = row, swap = rows;
        row = column, column = rows - 1 - above;
        rows = columns, columns = swap;
    }
    size_t plane = (size_t)extent.x * (size_t)extent.y, at = (size_t)(from.y + row) * (size_t)extent.x + (size_t)(from.x + column);

    size_t to = (size_t)(y * p->row + x);
    for (int c = 0; c < s->channels; ++c) {
        float v = source[(size_t)channel[c].x * plane + at];
        if (channel[c].y == CLVR_CHANNEL_RADIANCE) v = v_tonemap(v_min(v * s->exposure, s->ceiling));
        if (channel[c].y == CLVR_CHANNEL_NORMAL) v = fma(v, 0.5f, 0.5f);
        input[plane_start(p, n, s->channels, c) + to] = v;
    }

    float weight = s->opacity < 0 ? 1.0f : source[(size_t)s->opacity * plane + at];
    float radiance[3], albedo[3];
    for (int k = 0; k < 3; ++k) {
        albedo[k] = s->albedo < 0 ? 1.0f : v_max(source[(size_t)(s->albedo + k) * plane + at], s->albedo_floor);
        radiance[k] = v_min(source[(size_t)(s->beauty + k) * plane + at] * s->exposure, s->ceiling) / albedo[k];
        if (s->target >= 0) target[plane_start(p, n, 3, k) + to] = source[(size_t)(s->target + k) * plane + at] * s->exposure;
    }
    size_t pixel = ((size_t)n * (size_t)p->height + (size_t)y) * (size_t)p->width + (size_t)x;
    splatted[pixel] = (float4)(radiance[0], radiance[1], radiance[2], weight);
    remodulation[pixel] = (float4)(albedo[0] * weight, albedo[1] * weight, albedo[2] * weight, 0.0f);
}
