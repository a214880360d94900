// Points of lib/sobol.clh. One work-item a point; in: pixel, sample, purpose.
#include "lib/sobol.clh"

__kernel void sobol_values(__constant RenderParams* render, __global const uint4* in, __global float2* point, uint count) {
    uint i = (uint)get_global_id(0);
    if (i < count) point[i] = sobol_point(pixel_name(in[i].x, render), in[i].y, in[i].z);
}
