// A head in Hounsfield units, computed: skin, skull, brain, vessels with contrast agent. A work-item makes CLVR_WIDTH voxels along x;
// a launch makes some slices.
//
// Bodies are signed distances [mm, negative inside] of the parts that the host lists per cell of voxels (host/volume/phantom_anatomy.cpp);
// tissues are painted one over the other, each with a ramp of partial volume. A layer behind v_any() has no effect on the lanes that did not
// ask for it, so the packet's width does not matter. Smooth joins after I. Quilez, "smooth minimum" (the quadratic polynomial).
#include "lib/math.clh"
#include "lib/vec3.clh"
#include "shared/phantom.h"

static inline vfloat smooth_min(vfloat a, vfloat b, float blend, float quarter) {
    vfloat h = v_max(blend - fabs(a - b), (vfloat)(0.0f));
    return fma(h * h, (vfloat)(-quarter), v_min(a, b));
}
static inline vfloat smooth_max(vfloat a, vfloat b, float blend, float quarter) { return -smooth_min(-a, -b, blend, quarter); }

// Never 0, so that it can divide.
static inline vfloat length3(Vec3 v) { return sqrt(inner3(v, v) + 1e-12f); }
static inline Vec3 offset3(Vec3 p, float x, float y, float z) { return vec3(p.x - x, p.y - y, p.z - z); }

// Distance to a part's surface, to first order for ellipsoids and blocks: (f - 1) / |grad f|.
static inline vfloat part_distance(__global const PhantomPart* part, Vec3 p) {
    float4 a = part->a, b = part->b, c = part->c;
    if (part->kind == CLVR_PART_TUBE) {
        Vec3 from_start = offset3(p, a.x, a.y, a.z), axis = vec3_of(b);
        vfloat t = v_clamp(inner3(from_start, axis) * b.w, (vfloat)(0.0f), (vfloat)(1.0f));
        return length3(along(from_start, negated(axis), t)) - fma(t, (vfloat)(c.x), (vfloat)(a.w));
    }
    Vec3 d = offset3(p, part->center.x, part->center.y, part->center.z), inverse_radius = vec3((vfloat)(a.w), (vfloat)(b.w), (vfloat)(c.w));
    Vec3 q = vec3(inner3(vec3_of(a), d), inner3(vec3_of(b), d), inner3(vec3_of(c), d));
    if (part->kind == CLVR_PART_ELLIPSOID) {
        vfloat f = length3(q);
        return (f - 1.0f) * f / length3(product(q, inverse_radius));
    }
    Vec3 squared = product(q, q);
    vfloat f2 = length3(squared), f = sqrt(f2);
    return (f - 1.0f) * f * f2 / length3(product(product(squared, q), inverse_radius));
}

// The distance to a body; `start` is where this cell's lists of parts begin in `list`, by body.
static inline vfloat body_distance(int body, float far, __global const PhantomPart* parts, __global const uint* start,
                                   __global const uint* list, Vec3 p) {
    vfloat d = (vfloat)(far);
    for (uint i = start[body]; i < start[body + 1]; ++i) {
        __global const PhantomPart* part = parts + list[i];
        float4 center = part->center;
        vmask near = v_lt(length3(offset3(p, center.x, center.y, center.z)), (vfloat)(center.w));
        if (v_any(near)) {
            vfloat b = part_distance(part, p);
            vfloat joined = part->sign > 0 ? smooth_min(d, b, part->blend, part->quarter) : smooth_max(d, -b, part->blend, part->quarter);
            d = v_select(near, v_clamp(joined, (vfloat)(-far), (vfloat)(far)), d);
        }
    }
    return d;
}

// A hash of 32 bits (C. Wellons, "lowbias32").
static inline vuint scrambled(vuint h) {
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

static inline vfloat faded(vfloat t) { return t * t * t * fma(t, fma(t, (vfloat)(6.0f), (vfloat)(-15.0f)), (vfloat)(10.0f)); }
// -1..1 of ten bits.
static inline vfloat component(vuint bits) { return fma(v_float(bits & 1023u), (vfloat)(1.0f / 512.0f), (vfloat)(-1.0f)); }

// Gradient noise (K. Perlin, "Improving noise", 2002; gradients from a hash), about -0.8..0.8; one unit of its lattice is `period` mm.
static inline vfloat noise(Vec3 p, float period, uint key) {
    float per_mm = 1.0f / period;
    vfloat fx = floor(p.x * per_mm), fy = floor(p.y * per_mm), fz = floor(p.z * per_mm), scale = (vfloat)(per_mm);
    vfloat tx = fma(p.x, scale, -fx), ty = fma(p.y, scale, -fy), tz = fma(p.z, scale, -fz);
    vuint ix = v_uint_of_int(v_int(fx)), iy = v_uint_of_int(v_int(fy)), iz = v_uint_of_int(v_int(fz));
    vfloat plane[2], row[2], corner[2];
    for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 2; ++j) {
            vuint h_row = (iy + (uint)(j)) * 0x9E3779B1u ^ (iz + (uint)(k)) * 0x85EBCA77u ^ (vuint)(key);
            for (int i = 0; i < 2; ++i) {
                vuint h = scrambled((ix + (uint)(i)) * 0xC2B2AE3Du ^ h_row);
                Vec3 gradient = vec3(component(h), component(h >> 10), component(h >> 20));
                corner[i] = inner3(gradient, vec3(tx - (float)(i), ty - (float)(j), tz - (float)(k)));
            }
            row[j] = fma(faded(tx), corner[1] - corner[0], corner[0]);
        }
        plane[k] = fma(faded(ty), row[1] - row[0], row[0]);
    }
    return fma(faded(tz), plane[1] - plane[0], plane[0]);
}

// 0 at a, 1 at b and beyond.
static inline vfloat ramp(vfloat x, float a, float b) { return v_clamp((x - a) * (1.0f / (b - a)), (vfloat)(0.0f), (vfloat)(1.0f)); }
// Share of a voxel inside of a surface at distance d.
static inline vfloat inside(vfloat d, float per_mm) {
    return v_clamp(fma(d, (vfloat)(-per_mm), (vfloat)(0.5f)), (vfloat)(0.0f), (vfloat)(1.0f));
}
static inline vfloat paint(vfloat hu, vfloat value, vfloat share) { return fma(share, value - hu, hu); }
static inline vfloat paint_hu(vfloat hu, float value, vfloat share) { return paint(hu, (vfloat)(value), share); }

// Skin, fat under it, muscle with streaks of fat below.
static inline vfloat flesh(Vec3 p, vfloat skin, float per_mm, uint key) {
    vfloat streak = noise(vec3(p.x, p.y, p.z * 0.35f), 9.0f, key);
    vfloat fat_end = fma(streak, (vfloat)(2.0f), fma(ramp(p.z, 20.0f, 60.0f), (vfloat)(-1.5f), (vfloat)(6.0f)));
    vfloat hu = paint_hu((vfloat)(58.0f), -70.0f, v_clamp(fma(fabs(streak), (vfloat)(-14.0f), (vfloat)(0.8f)), (vfloat)(0.0f), (vfloat)(1.0f)));
    hu = paint_hu(hu, -95.0f, inside(-skin - fat_end, 0.7f));
    return paint_hu(hu, 65.0f, inside(-skin - 3.2f, per_mm));
}

// Depth of the sutures' groove in the outside of the braincase, 0..1.
static inline vfloat suture(Vec3 p, uint key) {
    vfloat n = noise(p, 5.0f, key), three = (vfloat)(3.0f), x = fabs(p.x), none = (vfloat)(9.0f);
    vfloat coronal = fma(n, three, fma(p.z - 60.0f, (vfloat)(-0.25f), p.y + 16.0f)); // > 0: behind it
    vfloat lambdoid = fma(n, three, fma(x, (vfloat)(1.05f), p.z - 92.0f));           // < 0: below it
    vfloat squamous = fma(n, (vfloat)(1.5f), length3(vec3((vfloat)(0.0f), p.y - 4.0f, p.z - 6.0f)) - 44.0f);
    vmask top = v_gt(p.z, (vfloat)(45.0f)), back = v_gt(p.y, (vfloat)(35.0f)), side = v_gt(x, (vfloat)(45.0f));
    vmask between = top & v_gt(coronal, (vfloat)(0.0f)) & v_gt(v_select(back, lambdoid, none), (vfloat)(0.0f));
    vfloat away = v_select(top, fabs(coronal), none);
    away = v_min(away, v_select(between, fabs(fma(n, three, p.x)), none)); // sagittal
    away = v_min(away, v_select(back & v_gt(p.z, (vfloat)(15.0f)), fabs(lambdoid), none));
    away = v_min(away, v_select(side & v_gt(p.z, (vfloat)(8.0f)), fabs(squamous), none));
    return v_clamp(1.3f - away, (vfloat)(0.0f), (vfloat)(1.0f));
}

// The braincase, a wall around the cavity, thinner at the temples, with sutures outside; the bones of the face; the walls of the orbits.
static inline vfloat bone_distance(const vfloat* body, Vec3 p, Vec3 folded, uint key) {
    vfloat cavity = body[CLVR_CAVITY], orbit = body[CLVR_ORBIT];
    vfloat temple = ramp(folded.x, 48.0f, 60.0f) * ramp(p.z, 62.0f, 40.0f);
    vfloat vault = cavity - fma(noise(p, 30.0f, key), (vfloat)(1.5f), fma(temple, (vfloat)(-2.2f), (vfloat)(6.0f)));
    vmask surface = v_lt(fabs(vault), (vfloat)(4.0f));
    if (v_any(surface)) vault = v_select(surface, fma(suture(p, key + 1), (vfloat)(1.1f), vault), vault);
    vault = v_select(v_lt(p.z, (vfloat)(-22.0f)), (vfloat)(9.0f), vault); // none around the spinal canal
    vfloat behind_rim = v_max(orbit - 2.0f, -66.0f - p.y);
    vfloat bone = smooth_min(vault, body[CLVR_FACE], 5.0f, 0.05f);
    bone = smooth_min(bone, behind_rim, 3.0f, 1.0f / 12.0f);
    return smooth_max(smooth_max(bone, -cavity, 1.0f, 0.25f), -orbit, 2.0f, 0.125f);
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

    vfloat bone = v_max(bone_distance(body, p, folded, key + 1), -window);
    if (v_any(v_lt(bone, (vfloat)(2.0f)))) {
        vfloat spongy = fma(noise(p, 3.3f, key + 3), (vfloat)(350.0f), (vfloat)(700.0f));
        vfloat hard = fma(noise(p, 11.0f, key + 4), (vfloat)(160.0f), (vfloat)(1250.0f));
        hu = paint(hu, paint(hard, spongy, inside(bone + 2.3f, 0.6f)), inside(bone, per_mm));
    }
    vmask socket = v_lt(orbit, (vfloat)(2.0f));
    if (v_any(socket)) {
        hu = paint_hu(hu, -85.0f, inside(v_max(v_max(orbit, skin + 4.0f), -bared), per_mm));
        hu = paint(hu, eye(folded, globe, per_mm), v_select(socket, inside(globe, per_mm), (vfloat)(0.0f)));
    }
    hu = paint_hu(hu, -1000.0f, inside(body[CLVR_AIR], per_mm));
    hu = paint_hu(hu, 48.0f, inside(body[CLVR_STRANDS], per_mm));
    hu = paint(hu, paint_hu((vfloat)(2300.0f), 1500.0f, inside(teeth + 1.3f, per_mm)), inside(teeth, per_mm)); // enamel, dentin
    if (v_any(v_lt(cavity, (vfloat)(2.0f)))) {
        vfloat fluid = paint_hu((vfloat)(9.0f), -1000.0f, inside(window, per_mm));
        hu = paint(hu, brain(body, p, folded, fluid, per_mm, key + 5), inside(cavity, per_mm));
    }
    vfloat over_window = v_min(cavity - 1.0f, -window);
    return paint_hu(hu, 360.0f, inside(v_max(body[CLVR_VESSELS], over_window), 1.4f * per_mm));
}

__kernel void phantom(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                      __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2), z0 = first_slice + slice;
    int4 dims = params->dims;
    if (x0 >= dims.x || y0 >= dims.y || slice >= slices) return;
    int cell = (slice / CLVR_CELL_Z * params->cells.y + y0 / CLVR_CELL_Y) * params->cells.x + x0 / CLVR_CELL_X;
    start += cell * CLVR_BODIES;

    vint ix = x0 + v_iota;
    vfloat hu = (vfloat)(-1000.0f);
    if (start[CLVR_SKIN] < start[CLVR_SKIN + 1]) {
        float4 origin = params->origin, spacing = params->spacing;
        Vec3 p = vec3(fma(v_float(ix), (vfloat)(spacing.x), (vfloat)(origin.x)), (vfloat)(fma((float)(y0), spacing.y, origin.y)),
                      (vfloat)(fma((float)(z0), spacing.z, origin.z)));
        // No head is symmetric: a slow bend of space, below CLVR_PHANTOM_BEND mm.
        vfloat unused;
        p.x = fma(v_sincos_turns(fma(p.z, (vfloat)(0.006f), p.y * 0.004f), &unused), (vfloat)(1.2f), p.x);
        p.z = fma(v_sincos_turns(fma(p.x, (vfloat)(0.005f), (vfloat)(0.1f)), &unused), (vfloat)(0.8f), p.z);
        Vec3 folded = vec3(sqrt(fma(p.x, p.x, (vfloat)(0.04f))), p.y, p.z);
        vfloat body[CLVR_BODIES];
        vmask head = -1;
        for (int k = 0; k < CLVR_BODIES; ++k)
            if (v_any(head)) {
                body[k] = body_distance(k, params->far[k], parts, start, list, k == CLVR_VESSELS ? p : folded);
                if (k == CLVR_SKIN) head = v_lt(body[k], (vfloat)(2.0f));
            }
        if (v_any(head)) hu = v_select(head, tissue(params, body, p, folded), hu);
    }

    // The scanner's noise: the sum of the four bytes of a hash, a deviation of about 9 HU.
    vuint h = scrambled(v_uint_of_int(ix) + (uint)(z0 * dims.y + y0) * 0x9E3779B1u ^ (vuint)(params->key1));
    vuint sum = (h & 255u) + ((h >> 8) & 255u) + ((h >> 16) & 255u) + (h >> 24);
    hu = fma(v_float(sum), (vfloat)(0.0625f), hu - 31.875f);
    vint rounded = v_int(floor(v_clamp(hu, (vfloat)(-1024.0f), (vfloat)(3071.0f)) + 0.5f));
    int lanes[CLVR_WIDTH];
    v_store(rounded, lanes);
    size_t at = ((size_t)(slice)*dims.y + y0) * dims.x + x0;
    for (int k = 0; k < CLVR_WIDTH && x0 + k < dims.x; ++k) out[at + k] = (short)(lanes[k]);
}
