// A tree of vessels with contrast agent in a lobe of soft tissue, in Hounsfield units. Parts from host/phantom/vessels.cpp.
#include "lib/solids.clh"

__kernel void vessels(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                      __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell * CLVR_VESSEL_BODIES;
    float per_mm = params->origin.w;
    uint key = params->key0;

    vfloat hu = (vfloat)(-1000.0f);
    vfloat lobe = body_distance(CLVR_VESSEL_LOBE, params->far[CLVR_VESSEL_LOBE], parts, start, list, m.p);
    vmask near = v_lt(lobe, (vfloat)(6.0f));
    if (v_any(near)) {
        vfloat outside = fma(noise(m.p, 14.0f, key), (vfloat)(2.0f), lobe);
        vfloat tissue = fma(noise(m.p, 3.0f, key + 1), (vfloat)(25.0f), fma(noise(m.p, 20.0f, key + 2), (vfloat)(30.0f), (vfloat)(-850.0f)));
        hu = v_select(near, paint(hu, tissue, inside(outside, 0.3f * per_mm)), hu);
    }
    vfloat tree = body_distance(CLVR_VESSEL_TREE, params->far[CLVR_VESSEL_TREE], parts, start, list, m.p);
    vfloat wall = paint_hu((vfloat)(380.0f), 120.0f, inside(-tree - 0.35f, per_mm));
    hu = paint(hu, wall, inside(tree, per_mm));
    store_made(params, &m, hu, 1.0f, slice, out);
}
