// A short mix of arithmetic and dependent reads, to compare devices: each lane does 8 fma and one read a step. The sum is stored so that nothing is optimised away.
#ifndef CLVR_WIDTH
#define CLVR_WIDTH 1 // lanes of a work-item: 1, 4, 8 or 16
#endif
#define CLVR_CAT_(x, y) x##y
#define CLVR_CAT(x, y) CLVR_CAT_(x, y)
#if CLVR_WIDTH == 1
typedef float vfloat;
#define STORE(value, i, to) ((to)[i] = (value))
#else
typedef CLVR_CAT(float, CLVR_WIDTH) vfloat;
#define STORE(value, i, to) CLVR_CAT(vstore, CLVR_WIDTH)(value, i, to)
#endif

// mask: entries of the table - 1, a power of two less one.
kernel void speed(global float* to, global const uint* table, uint mask, uint steps, uint items) {
    const uint i = get_global_id(0);
    if (i >= items) return;
    vfloat x = (vfloat)((float)i), y = (vfloat)(0.5f);
    uint at[CLVR_WIDTH];
    for (uint lane = 0; lane < CLVR_WIDTH; ++lane) at[lane] = i * CLVR_WIDTH + lane;
    for (uint step = 0; step < steps; ++step) {
        for (uint lane = 0; lane < CLVR_WIDTH; ++lane) at[lane] = table[(at[lane] * 747796405u + step) & mask];
        for (uint k = 0; k < 4; ++k) {
            x = fma(x, (vfloat)(0.75f), y);
            y = fma(y, (vfloat)(0.5f), x);
        }
    }
    uint sum = 0;
    for (uint lane = 0; lane < CLVR_WIDTH; ++lane) sum ^= at[lane];
    STORE(x + y + (vfloat)((float)sum), i, to);
}
