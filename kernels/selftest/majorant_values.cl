// Walks rays through the majorants, stop after stop, and compares each stop's majorant with the opacity there. One work-item a packet of rays.
#include "shared/render_params.h"
#include "lib/packet.clh"

// in: planes origin x y z [index], direction x y z [world, unit] of `stride` rays. excess: greatest opacity - majorant of a ray's stops (-1 without one);
// stops: their number. `depth`: optical depth between stops.
__kernel void majorant_values(VOLUME_ARGS, __global const float* in, __global float* excess, __global int* stops, float depth, uint stride, uint packets) {
    VOLUME_HERE(vol);
    size_t packet = get_global_id(0);
    if (packet >= packets) return;
    size_t at = packet * CLVR_WIDTH;
    Vec3 origin = {v_load(in + at), v_load(in + stride + at), v_load(in + 2 * stride + at)};
    Vec3 heading = {v_load(in + 3 * stride + at), v_load(in + 4 * stride + at), v_load(in + 5 * stride + at)};
    Walk w;
    vmask flying = begin_walk(&vol, &w, origin, heading, (vmask)(-1));
    vfloat greatest = (vfloat)(-1.0f);
    vint count = (vint)(0);
    while (v_any(flying)) {
        flying = walk_depth(&vol, &w, (vfloat)(depth), flying);
        if (!v_any(flying)) break;
        Int3 i;
        Vec3 p = stop_position(vol.p, &w, &i);
        vfloat above = opacity_of(&vol, stored_value_in(&vol, p, i)) - w.majorant;
        greatest = v_select(flying & v_gt(above, greatest), above, greatest);
        count -= flying; // a true mask is -1
    }
    v_store(greatest, excess + at);
    v_store(count, stops + at);
}
