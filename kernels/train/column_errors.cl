// Sums the errors of the result in the shifted gamma down the columns of each row of blocks (train/bands.cl). One work-item a packet of columns.
#include "lib/planes.clh"
#include "lib/shifted_gamma.clh"

// `result`, `target`: 3 planes an image. `columns`: [images * 3][blocks down][band_columns].
__kernel void column_errors(__constant DenoiseParams* p, __global const float* result, __global const float* target, __global float* columns) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, block = (int)get_global_id(1), plane = (int)get_global_id(2);
    if (x >= p->width || block >= band_blocks(p->height)) return;
    size_t start = plane_start(p, plane, 1, 0) + (size_t)x;
    vfloat sum = (vfloat)(0.0f);
    for (int y = block * CLVR_BAND_BLOCK; y < p->height && y < (block + 1) * CLVR_BAND_BLOCK; ++y) {
        size_t at = start + (size_t)(y * p->row);
        sum += shifted(v_load(result + at)) - shifted(v_load(target + at));
    }
    v_store(sum, columns + (size_t)(plane * band_blocks(p->height) + block) * (size_t)band_columns(p->width) + (size_t)x);
}
