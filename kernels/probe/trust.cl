// Evaluates every operation of trust_operations.h on n vectors of operands; result k of the list lies at results[k * n].
#pragma OPENCL FP_CONTRACT OFF
#include "shared/trust_operations.h"

#ifndef CLVR_WIDTH
#define CLVR_WIDTH 1 // or 16; divides n
#endif
#define CLVR_CAT_(x, y) x##y
#define CLVR_CAT(x, y) CLVR_CAT_(x, y)
#if CLVR_WIDTH == 1
#define OF(name) name
#define LOAD(from) ((from)[i])
#define STORE(value, to) ((to)[i] = (value))
#else
#define OF(name) CLVR_CAT(name, CLVR_WIDTH)
#define LOAD(from) OF(vload)(i, from)
#define STORE(value, to) OF(vstore)(value, i, to)
#endif

#define float_to_int(x) OF(as_uint)(OF(convert_int)(x))
#define float_to_uint(x) OF(convert_uint)(x)
#define int_to_float(x) OF(convert_float)(OF(as_int)(x))
#define uint_to_float(x) OF(convert_float)(x)
#define high_of_product(x, y) OF(convert_uint)((OF(convert_ulong)(x) * OF(convert_ulong)(y)) >> (OF(ulong))32)

kernel void trust(global uint* results, global const float* as, global const float* bs, global const float* cs, global const float* rs,
                  global const float* ss, global const float* ts, global const float* ws, global const uint* us, global const uint* vs, uint n) {
    const uint i = get_global_id(0);
    if (i >= n / CLVR_WIDTH) return;
    const OF(float) a = LOAD(as), b = LOAD(bs), c = LOAD(cs), r = LOAD(rs), s = LOAD(ss), t = LOAD(ts), w = LOAD(ws);
    const OF(uint) u = LOAD(us), v = LOAD(vs);
    global uint* to = results;
#define CLVR_FLOAT(name, expression)                                                                                                       \
    STORE(OF(as_uint)(expression), to);                                                                                                    \
    to += n;
#define CLVR_UINT(name, expression)                                                                                                        \
    STORE(expression, to);                                                                                                                 \
    to += n;
    CLVR_TRUST_OPERATIONS
    CLVR_TRUST_DENORMALS
}
