// Memory bandwidth with arithmetic: to = a + s b, one vector a work-item (J. McCalpin's STREAM triad). CLVR_STREAM as in copy.cl.
#include "lib/stream.clh"

kernel void triad(global const vfloat* a, global const vfloat* b, global vfloat* to, float s, uint vectors) {
    const uint i = get_global_id(0);
    if (i < vectors) STREAM(fma((vfloat)(s), b[i], a[i]), to + i);
}
