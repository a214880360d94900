// Delta tracking (Woodcock et al. 1965) against local majorants: how far each listed path flies before it collides. One work-item a packet.
#include "shared/render_params.h"
#include "lib/packet.clh"

// Stores where the flight ended, for the lanes whose flight has ended.
static inline void store_ends(Flights* f, vmask collided, __global float4* origin) {
    Vec3 p = along(f->walk.ray.o, f->walk.ray.d, f->walk.t); // not stop_position: in the half voxel at the volume's border that is another point
    float x[CLVR_WIDTH], y[CLVR_WIDTH], z[CLVR_WIDTH];
    int to[CLVR_WIDTH], hit[CLVR_WIDTH], ended[CLVR_WIDTH];
    v_store(p.x, x), v_store(p.y, y), v_store(p.z, z), v_store(f->path, to), v_store(collided, hit), v_store(f->held & v_not(f->flying), ended);
    for (int k = 0; k < CLVR_WIDTH; ++k)
        if (ended[k]) origin[to[k]] = (float4)(x[k], y[k], z[k], hit[k] ? 1.0f : -1.0f);
    f->held &= f->flying;
}

__kernel void free_flight(VOLUME_ARGS, __constant RenderParams* render, PATH_ARGS, __global const uint* active, uint count, uint bounce) {
    VOLUME_HERE(vol);
    Flights f;
    begin_flights(&f, count);
    vmask collided = (vmask)(0);
    for (uint n = 0; f.next < f.end || v_any(f.flying); ++n) {
        if (wants_paths(&f, n)) {
            if (v_any(f.held)) store_ends(&f, collided, origin);
            collided &= v_not(take_paths(&vol, &f, n, active, path_id, origin, heading, weight, origin));
        }
        if (!v_any(f.flying)) continue;
        f.flying = walk_depth(&vol, &f.walk, next_depth(&f, n, bounce * 2 + CLVR_STREAM_FLIGHT, render), f.flying);
        if (!v_any(f.flying)) continue;
        Int3 i;
        Vec3 p = stop_position(vol.p, &f.walk, &i);
        vfloat opacity = opacity_of(&vol, stored_value_in(&vol, p, i));
        vmask real = v_lt(f.choice * f.walk.majorant, opacity) & f.flying;
        keep_choice(&f, opacity, f.walk.majorant, f.flying & v_not(real));
        collided |= real;
        f.flying &= v_not(real);
    }
    if (v_any(f.held)) store_ends(&f, collided, origin);
}
