// Arithmetic rate: 12 independent chains of fma a work-item, CLVR_WIDTH lanes each; 4 cycles of latency on 2 units want 8. The same bits at every width.
#include "lib/vec.clh"

#define CHAINS 12

kernel void fma_rate(global float* to, float a, float b, uint rounds, uint items) {
    const uint i = get_global_id(0);
    if (i >= items) return;
    const vfloat start = v_float((vint)((int)i * CLVR_WIDTH) + v_iota), factor = (vfloat)(a), summand = (vfloat)(b);
    vfloat x[CHAINS];
#pragma unroll
    for (int c = 0; c < CHAINS; ++c) x[c] = fma(start, (vfloat)(0x1p-20f), (vfloat)((float)c));
    for (uint round = 0; round < rounds; ++round)
#pragma unroll
        for (int c = 0; c < CHAINS; ++c) x[c] = fma(x[c], factor, summand);
    vfloat sum = x[0];
#pragma unroll
    for (int c = 1; c < CHAINS; ++c) sum = sum + x[c];
    v_store(sum, to + i * CLVR_WIDTH);
}
