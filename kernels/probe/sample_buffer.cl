// Trilinear samples of a volume of side^3 floats in a buffer: each lane walks one column of it in `steps` steps. The same bits at every width.
#include "lib/vec.clh"

kernel void sample_buffer(global const float* from, global float* to, int side, int steps, uint items) {
    const uint i = get_global_id(0);
    if (i >= items) return;
    const vint lane = (vint)((int)i * CLVR_WIDTH) + v_iota;
    const vint y = lane / side, x = lane - y * side;
    const vint column = v_min(x, (vint)(side - 2)) + side * v_min(y, (vint)(side - 2));
    const float last = (float)(side - 1);
    const vfloat tx = (vfloat)(0.25f), ty = (vfloat)(0.625f);
    vfloat sum = (vfloat)(0.0f);
    for (int step = 0; step < steps; ++step) {
        const float z = ((float)step + 0.5f) * last / (float)steps;
        const int base = (int)z;
        const vfloat tz = (vfloat)(z - (float)base);
        const vint at = column + side * side * base;
        vfloat row[4];
#pragma unroll
        for (int k = 0; k < 4; ++k) {
            const vint corner = at + side * (k & 1) + side * side * (k >> 1);
            const vfloat low = v_gather(from, corner), high = v_gather(from, corner + 1);
            row[k] = fma(tx, high - low, low);
        }
        const vfloat near = fma(ty, row[1] - row[0], row[0]), far = fma(ty, row[3] - row[2], row[2]);
        sum = sum + fma(tz, far - near, near);
    }
    v_store(sum, to + i * CLVR_WIDTH);
}
