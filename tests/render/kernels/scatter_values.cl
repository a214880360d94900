// Samples, values and densities of lib/scatter.clh. One work-item an input.
#include "lib/scatter.clh"

// function 0: phase_sample(g, out, in.x, in.y), its density; 1: phase_density between the directions out and in;
// 2: surface_sample(in.x, in.y), its density; 3: surface_value of the direction in, its density.
__kernel void scatter_values(__global const float* lobe, float g, float4 normal, float4 out, float4 albedo, __global const float4* in, __global float4* result,
                             uint count, int function) {
    uint i = (uint)get_global_id(0);
    if (i >= count) return;
    Vec3 way = vec3_of(out), r = vec3(0.0f, 0.0f, 0.0f);
    Surface s = make_surface(lobe, vec3_of(normal), way, vec3_of(albedo));
    float density = 0.0f;
    if (function == 0) {
        r = phase_sample(g, way, in[i].x, in[i].y);
        density = phase_density(g, inner3(way, r));
    }
    if (function == 1) density = phase_density(g, inner3(way, vec3_of(in[i])));
    if (function == 2) {
        r = surface_sample(&s, in[i].x, in[i].y);
        surface_value(&s, r, &density);
    }
    if (function == 3) r = surface_value(&s, vec3_of(in[i]), &density);
    result[i] = (float4)(r.x, r.y, r.z, density);
}
