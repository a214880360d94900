// Philox blocks of given counters, and the uniform number of each block's first word. One work-item a packet.
#include "lib/random.clh"

__kernel void random_blocks(__global const uint* x, __global const uint* y, __global const uint* z, __global const uint* w, uint key0, uint key1,
                            __global uint* ox, __global uint* oy, __global uint* oz, __global uint* ow, __global float* number, uint packets) {
    size_t packet = get_global_id(0);
    if (packet >= packets) return;
    size_t at = packet * CLVR_WIDTH;
    RandomBlock r = philox(v_load(x + at), v_load(y + at), v_load(z + at), v_load(w + at), key0, key1);
    v_store(r.x, ox + at), v_store(r.y, oy + at), v_store(r.z, oz + at), v_store(r.w, ow + at);
    v_store(v_uniform(r.x), number + at);
}
