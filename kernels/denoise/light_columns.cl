// Sums of the least squares of noisy radiance by what is known of its light, over the columns of cells of `edge` rows (kernels/denoise/README.md, "Known
// light"); block_sums.cl makes cells of them. A work-item takes CLVR_WIDTH columns of a row of cells, and one colour.
#include "lib/plane_rows.clh"
#include "shared/denoise_params.h"

#define LEAST_OPACITY 0.00390625f // pixels of less do not count

// `planes` of width * height floats, finite. sums: [rows of cells][colour][CLVR_FIT_SUMS][width], in the order of LightFit.
__kernel void light_columns(__global const float* planes, int width, int height, LightPlanes plane, int edge, __global float* sums) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, cell = (int)get_global_id(1), colour = (int)get_global_id(2), y = cell * edge, left = width - x;
    if (x >= width || y >= height || colour >= 3) return;
    size_t size = (size_t)width * (size_t)height;
    int end = y + edge < height ? y + edge : height;
    vfloat zero = (vfloat)(0.0f), sum[CLVR_FIT_SUMS];
    for (int k = 0; k < CLVR_FIT_SUMS; ++k) sum[k] = zero;
    for (; y < end; ++y) {
        __global const float* at = planes + (size_t)y * (size_t)width + (size_t)x;
#define PLANE(first) row_pixels(at + (size_t)((first) + colour) * size, left)
        vfloat opacity = row_pixels(at + (size_t)plane.opacity * size, left);
        vfloat v[3] = {PLANE(plane.key), PLANE(plane.sky), PLANE(plane.albedo) * opacity};
#undef PLANE
        vfloat noisy = row_pixels(at + (size_t)(plane.noisy + colour) * size, left);
        // Noise grows with light, so relative errors count; those of very dark pixels count less.
        vfloat scale = fma(v[2], (vfloat)(0.05f), v[0] + v[1]) + 1e-6f;
        vmask counts = v_gt(opacity, (vfloat)(LEAST_OPACITY));
        vfloat weight = v_select(counts, opacity / (scale * scale), zero);
        // One path that is a hundred times as bright as what is known must not decide.
        vfloat value = v_min(noisy, scale * 100.0f);
        int k = 0;
        for (int r = 0; r < 3; ++r) {
            vfloat weighted = weight * v[r];
            for (int c = 0; c <= r; ++c, ++k) sum[k] = fma(weighted, v[c], sum[k]);
            sum[6 + r] = fma(weighted, value, sum[6 + r]);
        }
        sum[9] = fma(weight * value, value, sum[9]);
        sum[10] += v_select(counts, (vfloat)(1.0f), zero);
    }
    __global float* to = sums + (size_t)((cell * 3 + colour) * CLVR_FIT_SUMS) * (size_t)width + (size_t)x;
    for (int k = 0; k < CLVR_FIT_SUMS; ++k) store_row(to + (size_t)k * (size_t)width, left, sum[k]);
}
