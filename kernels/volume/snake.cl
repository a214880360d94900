// A young snake, coiled in its egg, in Hounsfield units: leathery shell (opened above), flesh with organs, skull, spine and ribs. Parts from
// host/phantom/snake.cpp.
#include "lib/solids.clh"

__kernel void snake(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                    __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell * CLVR_SNAKE_BODIES;
    Vec3 p = m.p;
    float per_mm = params->origin.w;
    uint key = params->key0;

    vfloat hu = (vfloat)(-1000.0f);
    vfloat egg = body_distance(CLVR_SNAKE_EGG, params->far[CLVR_SNAKE_EGG], parts, start, list, p);
    vmask near = v_lt(fabs(egg), (vfloat)(2.0f));
    if (v_any(near)) {
        // The rim of the opening is torn; the shell has low grains outside.
        vfloat rim = fma(noise(p, 6.0f, key), (vfloat)(3.0f), p.z - 3.0f);
        vfloat grains = fma(noise(p, 0.9f, key + 1), (vfloat)(0.12f), egg);
        hu = v_select(near, paint_hu(hu, 240.0f, inside(v_max(v_max(grains, -0.55f - egg), rim), per_mm)), hu);
    }
    vfloat flesh = body_distance(CLVR_SNAKE_FLESH, params->far[CLVR_SNAKE_FLESH], parts, start, list, p);
    near = v_lt(flesh, (vfloat)(1.0f));
    if (v_any(near)) {
        vfloat scales = fma(noise(p, 0.55f, key + 2), (vfloat)(0.07f), flesh);
        vfloat muscle = fma(noise(p, 1.7f, key + 3), (vfloat)(30.0f), (vfloat)(45.0f));
        vfloat gut = body_distance(CLVR_SNAKE_GUT, params->far[CLVR_SNAKE_GUT], parts, start, list, p);
        muscle = paint_hu(muscle, -60.0f, inside(gut, per_mm));
        hu = v_select(near, paint(hu, muscle, inside(scales, per_mm)), hu);
    }
    vfloat bone = body_distance(CLVR_SNAKE_BONE, params->far[CLVR_SNAKE_BONE], parts, start, list, p);
    near = v_lt(bone, (vfloat)(0.8f));
    if (v_any(near)) {
        vfloat mineral = fma(noise(p, 0.7f, key + 4), (vfloat)(250.0f), (vfloat)(1150.0f));
        hu = v_select(near, paint(hu, mineral, inside(bone, per_mm)), hu);
    }
    store_made(params, &m, hu, 1.0f, slice, out);
}
