// A head in Hounsfield units, computed: skin, skull, brain, vessels with contrast agent. A work-item makes CLVR_WIDTH voxels along x;
// a launch makes some slices.
//
// Bodies are solids (lib/solids.clh) of the parts in host/phantom/head.cpp; tissues are painted one over the other, each with a ramp of
// partial volume.
#include "lib/skull.clh"

// Skin, fat under it, muscle with streaks of fat below.
static inline vfloat flesh(Vec3 p, vfloat skin, float per_mm, uint key) {
    vfloat streak = noise(vec3(p.x, p.y, p.z * 0.35f), 9.0f, key);
    vfloat fat_end = fma(streak, (vfloat)(2.0f), fma(ramp(p.z, 20.0f, 60.0f), (vfloat)(-1.5f), (vfloat)(6.0f)));
    vfloat hu = paint_hu((vfloat)(58.0f), -70.0f, v_clamp(fma(fabs(streak), (vfloat)(-14.0f), (vfloat)(0.8f)), (vfloat)(0.0f), (vfloat)(1.0f)));
    hu = paint_hu(hu, -95.0f, inside(-skin - fat_end, 0.7f));
    return paint_hu(hu, 65.0f, inside(-skin - 3.2f, per_mm));
}

// Brain matter over what fills the braincase besides.
static inline vfloat brain(const vfloat* body, Vec3 p, Vec3 folded, vfloat hu, float per_mm, uint key) {
    vfloat cerebrum = body[CLVR_CEREBRUM], cerebellum = body[CLVR_CEREBELLUM];
    if (v_any(v_lt(cerebrum, (vfloat)(2.0f)))) {
        // Furrows run inwards: their pattern is that of the nearby surface, seen from the middle of the hemisphere; the sides differ.
        Vec3 from_middle = offset3(folded, 18.0f, 4.0f, 42.0f);
        vfloat l = length3(from_middle) + 4.0f;
        Vec3 other_side = vec3(v_select(v_lt(p.x, (vfloat)(0.0f)), (vfloat)(300.0f), (vfloat)(0.0f)), (vfloat)(0.0f), (vfloat)(0.0f));
        Vec3 q = along(other_side, from_middle, (l - cerebrum) / l);
        vfloat bend = noise(q, 19.0f, key);
        q = vec3(fma(bend, (vfloat)(10.0f), q.x), q.y, fma(bend, (vfloat)(-8.0f), q.z));
        vfloat furrow = fabs(noise(q, 13.0f, key + 1)) * 12.0f; // about mm from the furrow's middle
        vfloat gap = fma(ramp(-cerebrum, 20.0f, 1.0f), (vfloat)(-1.2f), furrow);
        vfloat fissure = fabs(p.x) - 0.9f;
        vfloat matter = smooth_max(smooth_max(cerebrum, -gap, 2.0f, 0.125f), -fissure, 2.0f, 0.125f);
        hu = paint(hu, paint_hu((vfloat)(36.0f), 28.0f, inside(matter + 3.2f, 0.6f)), inside(matter, per_mm)); // gray, white
    }
    if (v_any(v_lt(cerebellum, (vfloat)(2.0f)))) {
        vfloat leaf = fma(fma(folded.x, (vfloat)(0.12f), p.z), (vfloat)(0.27f), noise(p, 12.0f, key + 2) * 0.9f);
        vfloat groove = (0.5f - fabs(leaf - floor(leaf) - 0.5f)) * 3.7f; // mm from a groove's middle
        vfloat matter = smooth_max(cerebellum, fma(ramp(-cerebellum, 12.0f, 0.0f), (vfloat)(0.6f), -groove), 1.0f, 0.25f);
        hu = paint_hu(hu, 36.0f, inside(matter, per_mm));
    }
    return paint_hu(hu, 6.0f, inside(body[CLVR_VENTRICLES], per_mm));
}

// An eyeball: a firm shell around water, a lens.
static inline vfloat eye(Vec3 folded, vfloat globe, float per_mm) {
    Vec3 from_lens = offset3(folded, 32.0f, -84.5f, 15.0f);
    vfloat lens = length3(vec3(from_lens.x * 0.22f, from_lens.y * 0.5f, from_lens.z * 0.22f)) - 1.0f;
    vfloat hu = paint_hu((vfloat)(60.0f), 12.0f, inside(globe + 1.6f, per_mm));
    return paint_hu(hu, 95.0f, inside(lens, 2.0f * per_mm));
}

// What is where skin is less than 2 mm away.
static inline vfloat tissue(__constant const PhantomParams* params, const vfloat* body, Vec3 p, Vec3 folded) {
    vfloat skin = body[CLVR_SKIN], cavity = body[CLVR_CAVITY], orbit = body[CLVR_ORBIT], globe = body[CLVR_GLOBE], teeth = body[CLVR_TEETH];
    float per_mm = params->origin.w;
    uint key = params->key0;
    // The opened head has no flesh on the patient's left and a window in the skull above; distances to what is taken away.
    float opened = params->opened ? 0.0f : 1000.0f;
    vfloat bared = opened - p.x, window = v_max(7.0f - p.x, fma(p.y, (vfloat)(-0.1f), 66.0f - p.z)) + opened;

    vfloat hu = paint((vfloat)(-1000.0f), flesh(p, skin, per_mm, key), inside(v_max(skin, -bared), 0.6f * per_mm));

    vfloat bone = v_max(bone_distance(cavity, orbit, body[CLVR_FACE], p, folded, key + 1), -window);
    if (v_any(v_lt(bone, (vfloat)(2.0f)))) hu = paint(hu, bone_hu(bone, p, key + 3), inside(bone, per_mm));
    vmask socket = v_lt(orbit, (vfloat)(2.0f));
    if (v_any(socket)) {
        hu = paint_hu(hu, -85.0f, inside(v_max(v_max(orbit, skin + 4.0f), -bared), per_mm));
        hu = paint(hu, eye(folded, globe, per_mm), v_select(socket, inside(globe, per_mm), (vfloat)(0.0f)));
    }
    hu = paint_hu(hu, -1000.0f, inside(body[CLVR_AIR], per_mm));
    hu = paint_hu(hu, 48.0f, inside(body[CLVR_STRANDS], per_mm));
    hu = paint(hu, tooth_hu(teeth, per_mm), inside(teeth, per_mm));
    if (v_any(v_lt(cavity, (vfloat)(2.0f)))) {
        vfloat fluid = paint_hu((vfloat)(9.0f), -1000.0f, inside(window, per_mm));
        hu = paint(hu, brain(body, p, folded, fluid, per_mm, key + 5), inside(cavity, per_mm));
    }
    vfloat over_window = v_min(cavity - 1.0f, -window);
    return paint_hu(hu, 360.0f, inside(v_max(body[CLVR_VESSELS], over_window), 1.4f * per_mm));
}

__kernel void head(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                   __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell * CLVR_BODIES;

    vfloat hu = (vfloat)(-1000.0f);
    if (start[CLVR_SKIN] < start[CLVR_SKIN + 1]) {
        Vec3 p = m.p;
        // No head is symmetric: a slow bend of space, below CLVR_PHANTOM_BEND mm.
        vfloat unused;
        p.x = fma(v_sincos_turns(fma(p.z, (vfloat)(0.006f), p.y * 0.004f), &unused), (vfloat)(1.2f), p.x);
        p.z = fma(v_sincos_turns(fma(p.x, (vfloat)(0.005f), (vfloat)(0.1f)), &unused), (vfloat)(0.8f), p.z);
        Vec3 folded = vec3(sqrt(fma(p.x, p.x, (vfloat)(0.04f))), p.y, p.z);
        vfloat body[CLVR_BODIES];
        vmask near = -1;
        for (int k = 0; k < CLVR_BODIES; ++k)
            if (v_any(near)) {
                body[k] = body_distance(k, params->far[k], parts, start, list, k == CLVR_VESSELS ? p : folded);
                if (k == CLVR_SKIN) near = v_lt(body[k], (vfloat)(2.0f));
            }
        if (v_any(near)) hu = v_select(near, tissue(params, body, p, folded), hu);
    }
    store_made(params, &m, hu, 1.0f, slice, out);
}
