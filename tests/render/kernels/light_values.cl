// Samples and radiances of lib/light.clh. One work-item an input.
#include "lib/light.clh"

// function 0: light_sample(in.x, in.y): direction and density, radiance and whether it is directional; 1: light_radiance of the direction in:
// density in result.w; 2: environment_sample(in.x, in.y) and the density there; 3: environment_radiance of the direction in, its density.
__kernel void light_values(LIGHT_ARGS, __global const float4* in, __global float4* result, __global float4* radiance, uint count, int function) {
    uint i = (uint)get_global_id(0);
    if (i >= count) return;
    Light light = LIGHT_HERE;
    Vec3 dir = vec3_of(in[i]), met = vec3(0.0f, 0.0f, 0.0f);
    float density = 0.0f;
    bool directional = false;
    if (function == 0) directional = light_sample(&light, in[i].x, in[i].y, &dir, &met, &density);
    if (function == 1) met = light_radiance(&light, dir, &density);
    if (function == 2) dir = environment_sample(&light, in[i].x, in[i].y);
    if (function >= 2) met = environment_radiance(&light, dir, &density);
    result[i] = (float4)(dir.x, dir.y, dir.z, density);
    radiance[i] = (float4)(met.x, met.y, met.z, directional ? 1.0f : 0.0f);
}
