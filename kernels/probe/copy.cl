// Memory bandwidth: one vector a work-item, copied. CLVR_STREAM 1: with a hint, where the compiler has it, that the result is not read again soon, so
// that a CPU need not fetch the lines it overwrites. Buffers begin at 64-byte borders, which the plain float16 pointer needs.
#include "lib/stream.clh"

kernel void copy(global const vfloat* from, global vfloat* to, uint vectors) {
    const uint i = get_global_id(0);
    if (i < vectors) STREAM(from[i], to + i);
}
