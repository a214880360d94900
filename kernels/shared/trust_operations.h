// What the trust probe compares in bits, read by OpenCL C (trust.cl, on vectors of any width) and by C++ (runtime/trust/trust.cpp, the
// truth). CLVR_FLOAT(name, expression) has a float as its result, CLVR_UINT a 32-bit unsigned integer. Operands:
//   a b c  normal, 2^-31 < |x| < 2^61; in half of the vectors c is near -a*b, so that a second rounding shows
//   r      |r| < 2^31: halves, small values and both zeros among them;  s  in [0, 2^32)
//   t      denormal;  w  in [2^-20, 1);  u v  any 32 bits
#ifndef CLVR_TRUST_OPERATIONS
#define CLVR_TRUST_OPERATIONS                                                                                                              \
    CLVR_FLOAT(add, a + b)                                                                                                                 \
    CLVR_FLOAT(subtract, a - b)                                                                                                            \
    CLVR_FLOAT(multiply, a* b)                                                                                                             \
    CLVR_FLOAT(contraction, a* b + c)                                                                                                      \
    CLVR_FLOAT(fma, fma(a, b, c))                                                                                                          \
    CLVR_FLOAT(divide, a / b)                                                                                                              \
    CLVR_FLOAT(sqrt, sqrt(s))                                                                                                              \
    CLVR_FLOAT(smaller, a < b ? a : b)                                                                                                     \
    CLVR_FLOAT(floor, floor(r))                                                                                                            \
    CLVR_FLOAT(ceil, ceil(r))                                                                                                              \
    CLVR_FLOAT(trunc, trunc(r))                                                                                                            \
    CLVR_FLOAT(rint, rint(r))                                                                                                              \
    CLVR_UINT(float_to_int, float_to_int(r))                                                                                               \
    CLVR_UINT(float_to_uint, float_to_uint(s))                                                                                             \
    CLVR_FLOAT(int_to_float, int_to_float(u))                                                                                              \
    CLVR_FLOAT(uint_to_float, uint_to_float(u))                                                                                            \
    CLVR_UINT(multiply_high, mul_hi(u, v))                                                                                                 \
    CLVR_UINT(multiply_64_bit, high_of_product(u, v))

// Recorded, not required: no result of clvr depends on denormals.
#define CLVR_TRUST_DENORMALS                                                                                                               \
    CLVR_FLOAT(denormals_in, t * 0x1p126f)                                                                                                 \
    CLVR_FLOAT(denormals_out, w * 0x1p-126f)
#endif
