// For the self-test and tests: every elementary function of lib/math.clh at given arguments. One work-item a packet.
#include "lib/math.clh"

// function: 0 v_log(a), 1 v_exp(a), 2 v_sincos_turns(a) (cosine in second), 3 v_atan2_turns(a, b), 4 v_acos_half_turns(a).
__kernel void math_values(__global const float* a, __global const float* b, __global float* first, __global float* second, uint packets, int function) {
    size_t packet = get_global_id(0);
    if (packet >= packets) return;
    size_t at = packet * CLVR_WIDTH;
    vfloat x = v_load(a + at), y = v_load(b + at), one = (vfloat)(0.0f), two = (vfloat)(0.0f);
    if (function == 0) one = v_log(x);
    if (function == 1) one = v_exp(x);
    if (function == 2) one = v_sincos_turns(x, &two);
    if (function == 3) one = v_atan2_turns(x, y);
    if (function == 4) one = v_acos_half_turns(x);
    v_store(one, first + at);
    v_store(two, second + at);
}
