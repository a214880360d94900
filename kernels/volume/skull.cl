// A bare skull on a holder, in Hounsfield units: the head's bones and teeth (lib/skull.clh) without what fills them, wires that hold the jaw, ring
// artefacts of the scanner. Parts from host/phantom/skull.cpp.
#include "lib/skull.clh"

__kernel void skull(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                    __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell * CLVR_SKULL_BODIES;
    float per_mm = params->origin.w;
    uint key = params->key0;

    // The sides differ: a slow bend of space, below CLVR_PHANTOM_BEND mm.
    Vec3 p = vec3(fma(noise(m.p, 70.0f, key), (vfloat)(1.8f), m.p.x), fma(noise(m.p, 80.0f, key + 1), (vfloat)(1.8f), m.p.y),
                  fma(noise(m.p, 90.0f, key + 2), (vfloat)(1.8f), m.p.z));
    Vec3 folded = vec3(sqrt(fma(p.x, p.x, (vfloat)(0.04f))), p.y, p.z);
    vfloat body[CLVR_SKULL_BODIES];
    for (int k = 0; k < CLVR_SKULL_BODIES; ++k)
        body[k] = body_distance(k, params->far[k], parts, start, list, k < CLVR_SKULL_HOLDER ? folded : m.p);

    vfloat hu = paint_hu((vfloat)(-985.0f), 140.0f, inside(body[CLVR_SKULL_HOLDER], per_mm)); // plastic
    vfloat bone = bone_distance(body[CLVR_SKULL_CAVITY], body[CLVR_SKULL_ORBIT], body[CLVR_SKULL_FACE], p, folded, key + 3);
    bone = smooth_max(bone, -body[CLVR_SKULL_AIR], 0.6f, 1.0f / 2.4f);
    vmask near = v_lt(bone, (vfloat)(2.0f));
    if (v_any(near)) {
        vfloat pitted = fma(noise(p, 1.7f, key + 5), (vfloat)(0.25f), bone);
        hu = v_select(near, paint(hu, bone_hu(bone, p, key + 6), inside(pitted, per_mm)), hu);
    }
    vfloat teeth = body[CLVR_SKULL_TEETH];
    hu = paint(hu, tooth_hu(teeth, per_mm), inside(teeth, per_mm));
    hu = paint_hu(hu, 2900.0f, inside(body[CLVR_SKULL_WIRES], per_mm));
    hu = fma(rings(m.p, 1.6f * params->spacing.x, key + 8), (vfloat)(110.0f), hu);
    store_made(params, &m, hu, 2.0f, slice, out);
}
