// Bundles of fibres, glass and carbon, in a faint resin that fills the field of view, in Hounsfield units. Parts from host/phantom/fibres.cpp.
#include "lib/solids.clh"

__kernel void fibres(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                     __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell * CLVR_FIBRES_BODIES;
    Vec3 p = m.p;
    float per_mm = params->origin.w;
    uint key = params->key0;

    vfloat hu = fma(noise(p, 12.0f, key), (vfloat)(60.0f), (vfloat)(-760.0f));
    hu = paint_hu(hu, -1000.0f, ramp(noise(p, 6.0f, key + 1), 0.6f, 0.66f)); // bubbles
    vfloat carbon = body_distance(CLVR_FIBRES_CARBON, params->far[CLVR_FIBRES_CARBON], parts, start, list, p);
    hu = paint_hu(hu, 350.0f, inside(carbon, per_mm));
    vfloat glass = body_distance(CLVR_FIBRES_GLASS, params->far[CLVR_FIBRES_GLASS], parts, start, list, p);
    hu = paint(hu, fma(noise(p, 8.0f, key + 2), (vfloat)(150.0f), (vfloat)(1700.0f)), inside(glass, per_mm));
    store_made(params, &m, hu, 2.0f, slice, out);
}
