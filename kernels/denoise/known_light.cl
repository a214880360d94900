// What is known of the light: a key + b sky + c albedo opacity, the shares bilinear between the centres of cells (kernels/denoise/README.md, "Known light").
// A work-item takes CLVR_WIDTH pixels of a row, and one colour.
#include "lib/plane_rows.clh"
#include "shared/denoise_params.h"

// The two cells on either side of a place along an axis, and how far it is from the first to the second.
typedef struct {
    vint low, high;
    vfloat t;
} Between;

static inline Between between(vfloat place, int cells) {
    vfloat held = v_clamp(place, (vfloat)(0.0f), (vfloat)((float)(cells - 1))), low = floor(held);
    Between b = {v_int(low), v_min(v_int(low) + 1, (vint)(cells - 1)), held - low};
    return b;
}

// The film shows a picture's part from pixel (left, top) on. `shares`: [colour][down][across][a, b, c], cells of `edge` pixels of the picture. Writes the
// planes from `known` on.
__kernel void known_light(__global float* planes, int width, int height, LightPlanes plane, int left, int top, __global const float* shares, int across,
                          int down, int edge, uint known) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1), colour = (int)get_global_id(2), rest = width - x;
    if (x >= width || y >= height || colour >= 3) return;
    size_t size = (size_t)width * (size_t)height;
    float inverse = 1.0f / (float)edge;
    Between u = between(fma(v_float((vint)(left + x) + v_iota) + 0.5f, (vfloat)(inverse), (vfloat)(-0.5f)), across);
    Between v = between((vfloat)(fma((float)(top + y) + 0.5f, inverse, -0.5f)), down);
    vfloat corner[4] = {(1.0f - u.t) * (1.0f - v.t), u.t * (1.0f - v.t), (1.0f - u.t) * v.t, u.t * v.t};
    vint upper = (v.low + colour * down) * across, lower = (v.high + colour * down) * across;
    vint at[4] = {(upper + u.low) * 3, (upper + u.high) * 3, (lower + u.low) * 3, (lower + u.high) * 3};
    vfloat share[3];
    for (int k = 0; k < 3; ++k) {
        share[k] = (vfloat)(0.0f);
        for (int c = 0; c < 4; ++c) share[k] = fma(corner[c], v_gather_offset(shares, at[c], k), share[k]);
    }
    __global float* here = planes + (size_t)y * (size_t)width + (size_t)x;
#define PLANE(first) row_pixels(here + (size_t)((first) + colour) * size, rest)
    vfloat ambient = PLANE(plane.albedo) * row_pixels(here + (size_t)plane.opacity * size, rest);
    vfloat light = fma(share[0], PLANE(plane.key), fma(share[1], PLANE(plane.sky), fma(share[2], ambient, (vfloat)(0.0f))));
#undef PLANE
    store_row(here + ((size_t)known + (size_t)colour) * size, rest, light);
}
