// A stag beetle in Hounsfield units: thin shells of chitin around little, wing cases with furrows, jaws, legs, hairs. Parts from
// host/phantom/beetle.cpp.
#include "lib/solids.clh"

__kernel void beetle(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                     __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell * CLVR_BEETLE_BODIES;
    Vec3 p = m.p;
    p.x = sqrt(fma(p.x, p.x, (vfloat)(1e-6f))); // both sides
    float per_mm = params->origin.w;
    uint key = params->key0;

    vfloat hu = (vfloat)(-1000.0f);
    vfloat trunk = body_distance(CLVR_BEETLE_TRUNK, params->far[CLVR_BEETLE_TRUNK], parts, start, list, p);
    vmask near = v_lt(trunk, (vfloat)(1.0f));
    if (v_any(near)) {
        // Wing cases: furrows along the body above its middle, a seam between them; everywhere fine pits.
        vmask above = v_gt(p.z, (vfloat)(1.5f)) & v_gt(p.y, (vfloat)(-4.0f));
        vfloat unused, wave = v_sincos_turns(fma(p.x, (vfloat)(0.55f), noise(p, 9.0f, key) * 0.25f), &unused);
        vfloat relief = v_select(above, wave * 0.13f, (vfloat)(0.0f));
        relief = v_select(above & v_lt(p.x, (vfloat)(0.22f)), (vfloat)(0.35f), relief);
        vfloat outside = trunk + fma(noise(p, 0.6f, key + 1), (vfloat)(0.05f), relief);
        vfloat dust = fma(noise(p, 4.0f, key + 2), (vfloat)(220.0f), (vfloat)(-560.0f)); // dried tissue
        vfloat filled = paint_hu((vfloat)(-990.0f), -420.0f, inside(fma(noise(p, 7.0f, key + 3), (vfloat)(4.0f), (vfloat)(-0.4f)), 1.0f));
        vfloat body = paint(hu, paint(filled, dust, inside(trunk + 1.6f, 0.8f)), inside(outside, per_mm));
        vfloat chitin = fma(noise(p, 2.5f, key + 4), (vfloat)(90.0f), (vfloat)(420.0f));
        hu = v_select(near, paint(body, chitin, inside(v_max(outside, -0.5f - outside), per_mm)), hu);
    }
    vfloat limbs = body_distance(CLVR_BEETLE_LIMBS, params->far[CLVR_BEETLE_LIMBS], parts, start, list, p);
    near = v_lt(limbs, (vfloat)(0.8f));
    if (v_any(near)) {
        vfloat outside = fma(noise(p, 0.8f, key + 5), (vfloat)(0.06f), limbs);
        vfloat leg = paint_hu((vfloat)(470.0f), -500.0f, inside(outside + 0.45f, per_mm));
        hu = v_select(near, paint(hu, leg, inside(outside, per_mm)), hu);
    }
    vfloat hairs = body_distance(CLVR_BEETLE_HAIRS, params->far[CLVR_BEETLE_HAIRS], parts, start, list, p);
    hu = paint_hu(hu, 300.0f, inside(hairs, per_mm));
    store_made(params, &m, hu, 1.4f, slice, out);
}
