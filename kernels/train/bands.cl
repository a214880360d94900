// The band of the errors that eyes see as mottle: the mean of each block of CLVR_BAND_BLOCK pixels each way about the mean of the group of CLVR_BAND_GROUP blocks
// each way around it. Means over blocks that cover the picture are projections, so this is one. One work-item a group of a colour of an image.
#pragma OPENCL FP_CONTRACT OFF
#include "shared/denoise_params.h"

// `columns`: of column_errors. `bands`: [images * 3][blocks down][blocks across].
__kernel void bands(__constant DenoiseParams* p, __global const float* columns, __global float* bands) {
    int across = band_blocks(p->width), down = band_blocks(p->height);
    int left = (int)get_global_id(0) * CLVR_BAND_GROUP, top = (int)get_global_id(1) * CLVR_BAND_GROUP, plane = (int)get_global_id(2);
    if (left >= across || top >= down) return;
    int right = min(left + CLVR_BAND_GROUP, across), bottom = min(top + CLVR_BAND_GROUP, down);
    float sums[CLVR_BAND_GROUP * CLVR_BAND_GROUP], all = 0.0f;
    for (int j = top; j < bottom; ++j)
        for (int i = left; i < right; ++i) {
            __global const float* row = columns + (size_t)(plane * down + j) * (size_t)band_columns(p->width);
            float sum = 0.0f;
            for (int x = i * CLVR_BAND_BLOCK; x < p->width && x < (i + 1) * CLVR_BAND_BLOCK; ++x) sum += row[x];
            sums[(j - top) * CLVR_BAND_GROUP + i - left] = sum;
            all += sum;
        }
    float mean = all / (float)(band_length(left, right, p->width) * band_length(top, bottom, p->height));
    for (int j = top; j < bottom; ++j)
        for (int i = left; i < right; ++i)
            bands[(plane * down + j) * across + i] =
                sums[(j - top) * CLVR_BAND_GROUP + i - left] / (float)(band_length(i, i + 1, p->width) * band_length(j, j + 1, p->height)) - mean;
}
