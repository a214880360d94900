// Ratio tracking (Novak, Selle, Jarosz: "Residual ratio tracking for estimating attenuation in participating media", 2014) along the light samples of
// the listed paths; adds what arrives. Below 1/16 a roulette of one half ends or doubles the estimate. One work-item a packet.
#include "shared/render_params.h"
#include "lib/packet.clh"

// Adds the light that arrived, for the lanes whose flight has ended.
static inline void add_light(Flights* f, vfloat transmitted, __global const float4* shadow_light, __global float4* radiance) {
    float share[CLVR_WIDTH];
    int to[CLVR_WIDTH], ended[CLVR_WIDTH];
    v_store(transmitted, share), v_store(f->path, to), v_store(f->held & v_not(f->flying), ended);
    for (int k = 0; k < CLVR_WIDTH; ++k)
        if (ended[k]) {
            float4 sum = radiance[to[k]], light = shadow_light[to[k]];
            radiance[to[k]] = (float4)(fma(share[k], light.x, sum.x), fma(share[k], light.y, sum.y), fma(share[k], light.z, sum.z), sum.w);
        }
    f->held &= f->flying;
}

__kernel void transmittance(VOLUME_ARGS, __constant RenderParams* render, PATH_ARGS, __global const uint* shadowed, uint count, uint bounce) {
    VOLUME_HERE(vol);
    Flights f;
    begin_flights(&f, count);
    vfloat transmitted = (vfloat)(1.0f);
    for (uint n = 0; f.next < f.end || v_any(f.flying); ++n) {
        if (wants_paths(&f, n)) {
            if (v_any(f.held)) add_light(&f, transmitted, shadow_light, radiance);
            transmitted = v_select(take_paths(&vol, &f, n, shadowed, path_id, origin, shadow_heading, shadow_light, shadow_heading), (vfloat)(1.0f), transmitted);
        }
        if (!v_any(f.flying)) continue;
        f.flying = walk_depth(&vol, &f.walk, next_depth(&f, n, bounce * 2 + CLVR_STREAM_SHADOW, render), f.flying);
        if (!v_any(f.flying)) continue;
        Int3 i;
        Vec3 p = stop_position(vol.p, &f.walk, &i);
        vfloat passed = v_max(1.0f - opacity_of(&vol, stored_value_in(&vol, p, i)) / v_select(f.flying, f.walk.majorant, (vfloat)(1.0f)), (vfloat)(0.0f));
        transmitted = v_select(f.flying, transmitted * passed, transmitted);
        vmask weak = v_lt(transmitted, (vfloat)(0.0625f)) & f.flying;
        vmask ends = (weak & v_lt(f.choice, (vfloat)(0.5f))) | v_le(transmitted, (vfloat)(0.0f));
        // fma: a compiler makes a sum of "times 2", and would fuse it with the product before it.
        transmitted = v_select(weak, v_select(ends, (vfloat)(0.0f), fma(transmitted, (vfloat)(2.0f), (vfloat)(0.0f))), transmitted);
        f.flying &= v_not(ends);
        keep_choice(&f, (vfloat)(0.5f), (vfloat)(1.0f), weak & f.flying);
    }
    if (v_any(f.held)) add_light(&f, transmitted, shadow_light, radiance);
}
