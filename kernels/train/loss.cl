// The loss and its slope by the result (kernels/denoise/README.md, "Loss"). A work-item takes CLVR_WIDTH of a row's 16 lanes; lane l sums the columns
// l, l + 16, ... of all three colours, so that the sum is the same at every width.
#include "lib/planes.clh"
#include "lib/shifted_gamma.clh"

// 0: shifted gamma, 1: the reference's clipped gamma, 2: symmetric relative, 3: relative squared, 4: relative squared to the (frozen) result: noise to noise,
// 5: shifted gamma, squared, 6: the same and CLVR_BAND_WEIGHT times the square of its band (train/bands.cl)
#ifndef CLVR_LOSS
#define CLVR_LOSS 0
#endif

static inline vfloat sign_of(vfloat v) {
    return v_select(v_gt(v, (vfloat)(0.0f)), (vfloat)(1.0f), v_select(v_lt(v, (vfloat)(0.0f)), (vfloat)(-1.0f), (vfloat)(0.0f)));
}

// The loss of a result against its target, and the slope by the result. `band`: of the errors around it, for loss 6. As bands are a projection of the errors,
// the slope of the sum of their squares is twice the band.
static inline vfloat loss_of(vfloat result, vfloat target, vfloat band, vfloat* slope) {
#if CLVR_LOSS == 0
    vfloat error = shifted(result) - shifted(target);
    *slope = sign_of(error) * shifted_slope(result);
    return fabs(error);
#elif CLVR_LOSS == 1
    vfloat error = v_tonemap(result) - v_tonemap(target);
    *slope = sign_of(error) * v_tonemap_slope(result);
    return fabs(error);
#elif CLVR_LOSS == 2
    vfloat error = result - target, scale = fabs(result) + fabs(target) + FLOOR, loss = fabs(error) / scale;
    *slope = fma(-loss, sign_of(result), sign_of(error)) / scale;
    return loss;
#elif CLVR_LOSS == 3
    vfloat error = result - target, scale = fma(target, target, (vfloat)(FLOOR));
    *slope = error * 2.0f / scale;
    return error * error / scale;
#elif CLVR_LOSS == 5
    vfloat error = shifted(result) - shifted(target);
    *slope = error * 2.0f * shifted_slope(result);
    return error * error;
#elif CLVR_LOSS == 6
    vfloat error = shifted(result) - shifted(target);
    *slope = fma(band, (vfloat)(CLVR_BAND_WEIGHT), error) * 2.0f * shifted_slope(result);
    return fma(band * band, (vfloat)(CLVR_BAND_WEIGHT), error * error);
#else
    vfloat error = result - target, raised = result + FLOOR, scale = v_max(raised * raised, (vfloat)(1e-8f));
    *slope = error * 2.0f / scale;
    return error * error / scale;
#endif
}

// `result`, `target`, `gradient`: 3 planes an image. `bands`: [images * 3][blocks down][blocks across], read for loss 6. `share`: what a colour counts in the
// mean. `lanes`: [images][height][16].
__kernel void loss(__constant DenoiseParams* p, __global const float* result, __global const float* target, __global const float* bands,
                   __global float* gradient, float share, __global float* lanes) {
    int lane = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1), n = (int)get_global_id(2);
    if (lane >= 16 || y >= p->height) return;
    vfloat sum = (vfloat)(0.0f);
    for (int k = 0; k < 3; ++k) {
        size_t start = plane_start(p, n, 3, k) + (size_t)(y * p->row);
#if CLVR_LOSS == 6
        int first_block = ((n * 3 + k) * band_blocks(p->height) + y / CLVR_BAND_BLOCK) * band_blocks(p->width);
#endif
        for (int x = lane; x < p->width; x += 16) {
            size_t at = start + (size_t)x;
            vint column = (vint)(x) + v_iota;
            vmask inside = v_lt(column, (vint)(p->width));
#if CLVR_LOSS == 6
            vfloat band = v_gather(bands, v_min(column, (vint)(p->width - 1)) / CLVR_BAND_BLOCK + first_block);
#else
            vfloat band = (vfloat)(0.0f);
#endif
            vfloat slope, value = loss_of(v_load(result + at), v_load(target + at), band, &slope);
            v_store(v_select(inside, slope * share, (vfloat)(0.0f)), gradient + at);
            sum += v_select(inside, value, (vfloat)(0.0f));
        }
    }
    v_store(sum * share, lanes + (size_t)(n * p->height + y) * 16 + lane);
}
