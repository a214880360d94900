// Ratio tracking (Novak, Selle, Jarosz: "Residual ratio tracking for estimating attenuation in participating media", 2014) along the light samples of
// the listed paths; adds what arrives. Below 1/16 a roulette of one half ends or doubles the estimate. One work-item a packet.
#include "shared/render_params.h"
#include "lib/packet.clh"

__kernel void transmittance(VOLUME_ARGS, __constant RenderParams* render, PATH_ARGS, __global const uint* shadowed, uint count, uint bounce) {
    Volume vol = VOLUME_HERE;
    if (get_global_id(0) * CLVR_WIDTH >= count) return;
    vmask lanes;
    vint path = packet_paths(shadowed, count, &lanes);
    vuint pixel = v_uint_of_int(v_gather_int((__global const uint*)path_id, path * 2)), sample = v_uint_of_int(v_gather_int((__global const uint*)path_id, path * 2 + 1));
    Walk w;
    vmask flying = begin_walk(&vol, &w, packet_load3(origin, path), packet_load3(shadow_heading, path), lanes);
    vfloat transmitted = (vfloat)(1.0f);
    RandomBlock block;
    for (uint n = 0; v_any(flying); ++n) {
        vfloat depth, choice;
        collision_numbers(&block, n, pixel, sample, bounce * 4 + CLVR_STREAM_SHADOW, render, &depth, &choice);
        flying = walk_depth(&vol, &w, depth, flying);
        if (!v_any(flying)) break;
        Int3 i;
        Vec3 p = stop_position(vol.p, &w, &i);
        vfloat passed = v_max(1.0f - opacity_of(&vol, stored_value_in(&vol, p, i)) / v_select(flying, w.majorant, (vfloat)(1.0f)), (vfloat)(0.0f));
        transmitted = v_select(flying, transmitted * passed, transmitted);
        vmask weak = v_lt(transmitted, (vfloat)(0.0625f)) & flying;
        vmask ends = (weak & v_lt(choice, (vfloat)(0.5f))) | v_le(transmitted, (vfloat)(0.0f));
        // fma: twice a product is the sum of two, which a compiler would fuse with the product.
        transmitted = v_select(weak, v_select(ends, (vfloat)(0.0f), fma(transmitted, (vfloat)(2.0f), (vfloat)(0.0f))), transmitted);
        flying &= v_not(ends);
    }
    float share[CLVR_WIDTH];
    int to[CLVR_WIDTH], on[CLVR_WIDTH];
    v_store(transmitted, share), v_store(path, to), v_store(lanes, on);
    for (int k = 0; k < CLVR_WIDTH; ++k)
        if (on[k]) {
            float4 sum = radiance[to[k]], light = shadow_light[to[k]];
            radiance[to[k]] = (float4)(fma(share[k], light.x, sum.x), fma(share[k], light.y, sum.y), fma(share[k], light.z, sum.z), sum.w);
        }
}
