// What `rescaled` of lib/random.clh leaves of in.x after a decision between in.y and in.z. One work-item a number.
#include "lib/random.clh"

__kernel void rescaled_values(__global const float4* in, __global float* left, uint count) {
    uint i = (uint)get_global_id(0);
    if (i < count) left[i] = rescaled(in[i].x, in[i].y, in[i].z);
}
