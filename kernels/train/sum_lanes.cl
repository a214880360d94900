// Adds 16 lanes in a fixed tree: halves, quarters, eighths, sixteenths. One work-item a sum.
#pragma OPENCL FP_CONTRACT OFF

// `lanes`: [count][16].
__kernel void sum_lanes(__global const float* lanes, __global float* sums, uint first, uint count) {
    uint i = (uint)get_global_id(0);
    if (i >= count) return;
    float16 a = vload16(i, lanes);
    float8 b = a.lo + a.hi;
    float4 c = b.lo + b.hi;
    float2 d = c.lo + c.hi;
    sums[first + i] = d.x + d.y;
}
