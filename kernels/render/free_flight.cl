// Delta tracking (Woodcock et al. 1965) against local majorants: how far each listed path flies before it collides. One work-item a packet.
#include "shared/render_params.h"
#include "lib/packet.clh"

__kernel void free_flight(VOLUME_ARGS, __constant RenderParams* render, PATH_ARGS, __global const uint* active, uint count, uint bounce) {
    Volume vol = VOLUME_HERE;
    if (get_global_id(0) * CLVR_WIDTH >= count) return;
    vmask lanes;
    vint path = packet_paths(active, count, &lanes);
    vuint pixel = v_uint_of_int(v_gather_int((__global const uint*)path_id, path * 2)), sample = v_uint_of_int(v_gather_int((__global const uint*)path_id, path * 2 + 1));
    Walk w;
    vmask flying = begin_walk(&vol, &w, packet_load3(origin, path), packet_load3(heading, path), lanes);
    vmask collided = (vmask)(0);
    RandomBlock block;
    for (uint n = 0; v_any(flying); ++n) {
        vfloat depth, choice;
        collision_numbers(&block, n, pixel, sample, bounce * 4 + CLVR_STREAM_FLIGHT, render, &depth, &choice);
        flying = walk_depth(&vol, &w, depth, flying);
        if (!v_any(flying)) break;
        Int3 i;
        Vec3 p = stop_position(vol.p, &w, &i);
        vmask real = v_lt(choice * w.majorant, opacity_of(&vol, stored_value_in(&vol, p, i))) & flying;
        collided |= real;
        flying &= v_not(real);
    }
    Vec3 p = along(w.ray.o, w.ray.d, w.t); // not stop_position: in the half voxel at the volume's border that is another point
    float x[CLVR_WIDTH], y[CLVR_WIDTH], z[CLVR_WIDTH];
    int to[CLVR_WIDTH], hit[CLVR_WIDTH], on[CLVR_WIDTH];
    v_store(p.x, x), v_store(p.y, y), v_store(p.z, z), v_store(path, to), v_store(collided, hit), v_store(lanes, on);
    for (int k = 0; k < CLVR_WIDTH; ++k)
        if (on[k]) origin[to[k]] = (float4)(x[k], y[k], z[k], hit[k] ? 1.0f : -1.0f);
}
