// A machine part as an industrial CT scanner shows it, in Hounsfield units: cast aluminium with voids, steel in it, air around. Beam hardening makes
// values fall towards the axis of the scan (cupping) and beside steel. Parts from host/phantom/machine.cpp.
#include "lib/solids.clh"

__kernel void machine(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                      __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell * CLVR_MACHINE_BODIES;
    Vec3 p = m.p;
    float per_mm = params->origin.w;

    vfloat hu = (vfloat)(-1000.0f);
    vfloat cupping = fma(v_min(fma(p.x, p.x, p.y * p.y) * (1.0f / 2500.0f), (vfloat)(1.0f)), (vfloat)(0.14f), (vfloat)(0.86f));
    vfloat steel = body_distance(CLVR_MACHINE_STEEL, params->far[CLVR_MACHINE_STEEL], parts, start, list, p);
    vfloat aluminium = body_distance(CLVR_MACHINE_ALUMINIUM, params->far[CLVR_MACHINE_ALUMINIUM], parts, start, list, p);
    vmask near = v_lt(aluminium, (vfloat)(2.0f));
    if (v_any(near)) {
        vfloat shadow = fma(ramp(steel, 5.0f, 0.0f), (vfloat)(-0.1f), cupping);
        vfloat cast = paint_hu(fma(shadow, (vfloat)(2300.0f), (vfloat)(-1000.0f)), -900.0f, ramp(noise(p, 2.6f, params->key0), 0.62f, 0.72f));
        hu = v_select(near, paint(hu, cast, inside(aluminium, per_mm)), hu);
    }
    hu = paint(hu, fma(cupping, (vfloat)(3900.0f), (vfloat)(-1000.0f)), inside(steel, per_mm));
    store_made(params, &m, hu, 2.0f, slice, out);
}
