// Adds runs of numbers in order: total i is the sum of values[i * item + j * step] over j < run. One work-item a total.
#pragma OPENCL FP_CONTRACT OFF

__kernel void sum_runs(__global const float* values, __global float* totals, uint first, uint count, uint item, uint step, uint run) {
    uint i = (uint)get_global_id(0);
    if (i >= count) return;
    float sum = 0.0f;
    for (uint j = 0; j < run; ++j) sum += values[(size_t)i * item + (size_t)j * step];
    totals[first + i] = sum;
}
