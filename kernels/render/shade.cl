// What happens at the end of a segment: light met by a path that left the volume; else scattering, a light sample, the next direction, roulette.
// One work-item an entry of `active`; state[entry] gets bit 0 for a path that goes on, bit 1 for a light sample to trace.
#include "lib/light.clh"
#include "lib/paths.clh"
#include "lib/scatter.clh"
#include "lib/sobol.clh"
#include "lib/volume.clh"

#define ROULETTE_FROM 3 // bounces

static inline float greatest(Vec3 v) { return v_max(v_max(v.x, v.y), v.z); }

__kernel void shade(VOLUME_ARGS, LIGHT_ARGS, __global const float* lobe, PATH_ARGS, __global const uint* active, __global uint* state, uint count, uint bounce) {
    VOLUME_HERE(vol);
    Light light = LIGHT_HERE;
    uint entry = (uint)get_global_id(0);
    if (entry >= count) return;
    uint path = active[entry];
    state[entry] = 0u;
    float4 at = origin[path], sum = radiance[path], way = heading[path];
    Vec3 dir = vec3_of(way), throughput = vec3_of(weight[path]);
    if (at.w < 0.0f) { // a camera ray sees no light: the background is added below the picture at the end
        if (bounce > 0) {
            float density;
            Vec3 met = product(throughput, light_radiance(&light, dir, &density));
            met = along(vec3_of(sum), met, way.w / (way.w + density));
            radiance[path] = (float4)(met.x, met.y, met.z, sum.w);
        }
        return;
    }
    if (bounce == 0) radiance[path] = (float4)(sum.x, sum.y, sum.z, 1.0f);
    if (render->bounces > 0 && bounce >= (uint)render->bounces) return;

    Vec3 p = vec3_of(at);
    Vec3 albedo = albedo_of(&vol, stored_value(&vol, p));
    uint2 id = path_id[path];
    uint name = pixel_name(id.x, render);
    float2 for_light = sobol_point(name, id.y, bounce * 4 + CLVR_POINTS_LIGHT), for_direction = sobol_point(name, id.y, bounce * 4 + CLVR_POINTS_DIRECTION);

    bool at_surface = false;
    Surface surface;
    if (vol.p->shading != 1) {
        Vec3 gradient = world_gradient(&vol, p);
        float steepness = sqrt(inner3(gradient, gradient));
        float chance = surface_chance(vol.p, steepness);
        at_surface = for_direction.x < chance;
        for_direction.x = at_surface ? rescaled(for_direction.x, 0.0f, chance) : rescaled(for_direction.x, chance, 1.0f);
        if (at_surface) surface = make_surface(lobe, scaled(gradient, -1.0f / steepness), negated(dir), albedo);
    }

    Vec3 to_light, incoming;
    float light_density, own_density;
    bool directional = light_sample(&light, for_light.x, for_light.y, &to_light, &incoming, &light_density);
    Vec3 value;
    if (at_surface) value = surface_value(&surface, to_light, &own_density);
    else {
        own_density = phase_density(render->phase_g, inner3(dir, to_light));
        value = scaled(albedo, own_density);
    }
    // Balance heuristic: value L / light_density * light_density / (light_density + own_density).
    if (!directional) value = scaled(value, light_density > 0.0f ? 1.0f / (light_density + own_density) : 0.0f);
    Vec3 adds = product(product(throughput, value), incoming);
    uint flags = 0u;
    if (greatest(adds) > 0.0f) {
        float2 for_shadow = sobol_point(name, id.y, bounce * 4 + CLVR_POINTS_SHADOW);
        shadow_heading[path] = (float4)(to_light.x, to_light.y, to_light.z, for_shadow.y);
        shadow_light[path] = (float4)(adds.x, adds.y, adds.z, for_shadow.x);
        flags = 2u;
    }

    Vec3 next;
    if (at_surface) {
        next = surface_sample(&surface, for_direction.x, for_direction.y);
        value = surface_value(&surface, next, &own_density);
        throughput = product(throughput, scaled(value, own_density > 0.0f ? 1.0f / own_density : 0.0f));
    } else {
        next = phase_sample(render->phase_g, dir, for_direction.x, for_direction.y);
        own_density = phase_density(render->phase_g, inner3(dir, next));
        throughput = product(throughput, albedo);
    }
    float strength = greatest(throughput);
    if (strength > 0.0f) {
        float2 for_flight = sobol_point(name, id.y, (bounce + 1) * 4 + CLVR_POINTS_FLIGHT);
        bool goes_on = true;
        if (bounce >= ROULETTE_FROM || strength < 0x1p-60f) {
            float survival = v_min(strength, bounce >= 1024 ? 0.999f : 1.0f); // an unlimited path in a white medium ends, too
            goes_on = for_flight.x < survival;
            for_flight.x = goes_on ? rescaled(for_flight.x, 0.0f, survival) : 0.0f;
            throughput = scaled(throughput, 1.0f / v_max(survival, 0x1p-100f));
        }
        if (goes_on) flags |= 1u;
        heading[path] = (float4)(next.x, next.y, next.z, own_density);
        weight[path] = (float4)(throughput.x, throughput.y, throughput.z, for_flight.x);
        origin[path].w = for_flight.y;
    }
    state[entry] = flags;
}
