// A head in Hounsfield units, computed: skin, skull, brain, vessels with contrast agent. A work-item makes CLVR_WIDTH voxels along x.
//
// Bodies are signed distances [mm, negative inside] of the parts that the host lists per cell of voxels (host/volume/phantom_anatomy.cpp);
// tissues are painted one over the other, each with a ramp of partial volume. Smooth joins after I. Quilez, "smooth minimum" (polynomial,
// quadratic).
#include "lib/math.clh"
#include "shared/phantom.h"

typedef struct {
    vfloat x, y, z;
} Point;

typedef struct {
    __global const PhantomPart* parts;
    __global const uint* start; // [cells * CLVR_BODIES + 1]
    __global const uint* list;
    uint first; // entry of this cell's first body in start
    __constant PhantomParams* params;
} Anatomy;

inline vfloat length3(vfloat x, vfloat y, vfloat z) { return sqrt(fma(x, x, fma(y, y, fma(z, z, (vfloat)(1e-12f))))); }

inline vfloat smooth_min(vfloat a, vfloat b, float blend, float quarter) {
    vfloat h = v_max(blend - fabs(a - b), (vfloat)(0.0f));
    return fma(h * h, (vfloat)(-quarter), v_min(a, b));
}
inline vfloat smooth_max(vfloat a, vfloat b, float blend, float quarter) { return -smooth_min(-a, -b, blend, quarter); }

// Distance to a part's surface, to first order for ellipsoids and blocks: (f - 1) / |grad f|.
inline vfloat part_distance(__global const PhantomPart* part, Point p) {
    float4 a = part->a, b = part->b, c = part->c;
    if (part->kind == CLVR_PART_TUBE) {
        vfloat x = p.x - a.x, y = p.y - a.y, z = p.z - a.z;
        vfloat t = v_clamp(fma(x, (vfloat)(b.x), fma(y, (vfloat)(b.y), z * b.z)) * b.w, (vfloat)(0.0f), (vfloat)(1.0f));
        return length3(fma(t, (vfloat)(-b.x), x), fma(t, (vfloat)(-b.y), y), fma(t, (vfloat)(-b.z), z)) -
               fma(t, (vfloat)(c.x), (vfloat)(a.w));
    }
    vfloat x = p.x - part->center.x, y = p.y - part->center.y, z = p.z - part->center.z;
    vfloat qx = fma((vfloat)(a.x), x, fma((vfloat)(a.y), y, a.z * z));
    vfloat qy = fma((vfloat)(b.x), x, fma((vfloat)(b.y), y, b.z * z));
    vfloat qz = fma((vfloat)(c.x), x, fma((vfloat)(c.y), y, c.z * z));
    if (part->kind == CLVR_PART_ELLIPSOID) {
        vfloat f = length3(qx, qy, qz);
        return (f - 1.0f) * f / length3(qx * a.w, qy * b.w, qz * c.w);
    }
    vfloat sx = qx * qx, sy = qy * qy, sz = qz * qz, f2 = length3(sx, sy, sz), f = sqrt(f2);
    return (f - 1.0f) * f * f2 / length3(sx * qx * a.w, sy * qy * b.w, sz * qz * c.w);
}

inline vfloat body_distance(const Anatomy* anatomy, int body, Point p) {
    vfloat far = (vfloat)(anatomy->params->far[body]), d = far;
    uint end = anatomy->start[anatomy->first + body + 1];
    for (uint i = anatomy->start[anatomy->first + body]; i < end; ++i) {
        __global const PhantomPart* part = anatomy->parts + anatomy->list[i];
        vmask near = v_lt(length3(p.x - part->center.x, p.y - part->center.y, p.z - part->center.z), (vfloat)(part->center.w));
        if (!v_any(near)) continue;
        vfloat b = part_distance(part, p);
        vfloat joined = part->sign > 0 ? smooth_min(d, b, part->blend, part->quarter) : smooth_max(d, -b, part->blend, part->quarter);
        d = v_select(near, v_clamp(joined, -far, far), d);
    }
    return d;
}
inline bool has(const Anatomy* anatomy, int body) {
    return anatomy->start[anatomy->first + body] < anatomy->start[anatomy->first + body + 1];
}

inline vuint scrambled(vuint h) {
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

inline vfloat faded(vfloat t) { return t * t * t * fma(t, fma(t, (vfloat)(6.0f), (vfloat)(-15.0f)), (vfloat)(10.0f)); }

// Gradient noise (Perlin), about -0.8..0.8, with gradients of 10 bits a component; one lattice unit is 1 / per_mm.
inline vfloat noise(Point p, float per_mm, uint key) {
    vfloat fx = floor(p.x * per_mm), fy = floor(p.y * per_mm), fz = floor(p.z * per_mm), scale = (vfloat)(per_mm);
    vfloat tx = fma(p.x, scale, -fx), ty = fma(p.y, scale, -fy), tz = fma(p.z, scale, -fz);
    vuint ix = v_uint_of_int(v_int(fx)), iy = v_uint_of_int(v_int(fy)), iz = v_uint_of_int(v_int(fz));
    vfloat along_z[2], along_y[2], along_x[2];
    for (int k = 0; k < 2; ++k) {
        for (int j = 0; j < 2; ++j) {
            vuint row = (iy + (uint)(j)) * 0x9E3779B1u ^ (iz + (uint)(k)) * 0x85EBCA77u ^ (vuint)(key);
            for (int i = 0; i < 2; ++i) {
                vuint h = scrambled((ix + (uint)(i)) * 0xC2B2AE3Du ^ row);
                vfloat gx = fma(v_float(h & 1023u), (vfloat)(1.0f / 512.0f), (vfloat)(-1.0f));
                vfloat gy = fma(v_float((h >> 10) & 1023u), (vfloat)(1.0f / 512.0f), (vfloat)(-1.0f));
                vfloat gz = fma(v_float(h >> 22), (vfloat)(1.0f / 512.0f), (vfloat)(-1.0f));
                along_x[i] = fma(gx, tx - (float)(i), fma(gy, ty - (float)(j), gz * (tz - (float)(k))));
            }
            along_y[j] = fma(faded(tx), along_x[1] - along_x[0], along_x[0]);
        }
        along_z[k] = fma(faded(ty), along_y[1] - along_y[0], along_y[0]);
    }
    return fma(faded(tz), along_z[1] - along_z[0], along_z[0]);
}

// Share of a voxel inside of a surface at distance d.
inline vfloat inside(vfloat d, float per_mm) { return v_clamp(fma(d, (vfloat)(-per_mm), (vfloat)(0.5f)), (vfloat)(0.0f), (vfloat)(1.0f)); }
inline vfloat paint(vfloat hu, vfloat value, vfloat share) { return fma(share, value - hu, hu); }
// 0 at a, 1 at b and beyond.
inline vfloat ramp(vfloat x, float a, float b) { return v_clamp((x - a) * (1.0f / (b - a)), (vfloat)(0.0f), (vfloat)(1.0f)); }

// Depth of the sutures' groove in the outside of the braincase [mm].
inline vfloat suture(Point p, uint key) {
    vfloat n = noise(p, 1.0f / 5.0f, key), three = (vfloat)(3.0f), x = fabs(p.x);
    vfloat coronal = fma(n, three, fma(p.z - 60.0f, (vfloat)(-0.25f), p.y + 16.0f)); // > 0: behind it
    vfloat lambdoid = fma(n, three, fma(x, (vfloat)(1.05f), p.z - 92.0f));           // < 0: below it, where y is large
    vfloat squamous = fma(n, (vfloat)(1.5f), length3((vfloat)(0.0f), p.y - 4.0f, p.z - 6.0f) - 44.0f);
    vmask top = v_gt(p.z, (vfloat)(45.0f)), back = v_gt(p.y, (vfloat)(35.0f)), side = v_gt(x, (vfloat)(45.0f));
    vfloat away = (vfloat)(9.0f);
    away = v_select(top, v_min(away, fabs(coronal)), away);
    away = v_select(top & v_gt(coronal, (vfloat)(0.0f)) & (v_gt(lambdoid, (vfloat)(0.0f)) | v_not(back)),
                    v_min(away, fabs(fma(n, three, p.x))), away);
    away = v_select(back & v_gt(p.z, (vfloat)(15.0f)), v_min(away, fabs(lambdoid)), away);
    away = v_select(side & v_gt(p.z, (vfloat)(8.0f)), v_min(away, fabs(squamous)), away);
    return v_clamp(1.3f - away, (vfloat)(0.0f), (vfloat)(1.0f));
}

// Brain matter and fluid inside of the braincase.
inline vfloat brain(const Anatomy* anatomy, Point p, Point folded, vfloat hu, float per_mm, uint key) {
    vfloat cerebrum = body_distance(anatomy, CLVR_CEREBRUM, folded);
    if (v_any(v_lt(cerebrum, (vfloat)(2.0f)))) {
        // Furrows run inwards: their pattern lives on directions from the middle of the hemisphere, scaled to the surface.
        vfloat x = folded.x - 18.0f, y = p.y - 4.0f, z = p.z - 42.0f;
        vfloat to_surface = 60.0f / (length3(x, y, z) + 6.0f);
        vfloat other_side = v_select(v_lt(p.x, (vfloat)(0.0f)), (vfloat)(300.0f), (vfloat)(0.0f));
        Point q = {fma(x, to_surface, other_side), y * to_surface, z * to_surface};
        vfloat bend = noise(q, 1.0f / 23.0f, key + 1);
        Point r = {fma(bend, (vfloat)(9.0f), q.x), q.y, fma(bend, (vfloat)(-7.0f), q.z)};
        vfloat furrow = fabs(noise(r, 1.0f / 17.0f, key + 2)) * 15.0f; // about mm from the furrow's middle
        vfloat depth = ramp(-cerebrum, 20.0f, 1.0f);                   // furrows close towards the inside
        vfloat gap = fma(depth, (vfloat)(-1.5f), furrow);
        vfloat fissure = fabs(p.x) - 0.9f;
        vfloat matter = smooth_max(smooth_max(cerebrum, -gap, 2.0f, 0.125f), -fissure, 2.0f, 0.125f);
        vfloat gray = (vfloat)(39.0f), white = (vfloat)(29.0f);
        vfloat core = inside(matter + 3.2f, 0.6f);
        hu = paint(hu, paint(gray, white, core), inside(matter, per_mm));
    }
    if (has(anatomy, CLVR_CEREBELLUM)) {
        vfloat cerebellum = body_distance(anatomy, CLVR_CEREBELLUM, folded);
        vfloat leaf = fma(fma(folded.x, (vfloat)(0.12f), p.z), (vfloat)(0.27f), noise(p, 1.0f / 12.0f, key + 3) * 0.9f);
        vfloat groove = (0.5f - fabs(leaf - floor(leaf) - 0.5f)) * 3.7f; // mm from a groove's middle
        vfloat matter = smooth_max(cerebellum, fma(ramp(-cerebellum, 12.0f, 0.0f), (vfloat)(0.6f), -groove), 1.0f, 0.25f);
        hu = paint(hu, (vfloat)(37.0f), inside(matter, per_mm));
    }
    if (has(anatomy, CLVR_VENTRICLES)) hu = paint(hu, (vfloat)(6.0f), inside(body_distance(anatomy, CLVR_VENTRICLES, folded), per_mm));
    return hu;
}

// What is where skin is at most 2 mm away: layers painted one over the other. A layer behind v_any() has no effect on lanes that do not ask
// for it.
inline vfloat tissue(const Anatomy* anatomy, Point p, Point folded, vfloat skin, float per_mm, uint key) {
    // Skin, fat under it, muscle with streaks of fat below.
    Point streak = {p.x, p.y, p.z * 0.35f};
    vfloat n = noise(streak, 1.0f / 9.0f, key + 4);
    vfloat fat_end = fma(n, (vfloat)(2.0f), fma(ramp(p.z, 20.0f, 60.0f), (vfloat)(-2.0f), (vfloat)(5.0f)));
    vfloat flesh =
        paint((vfloat)(58.0f), (vfloat)(-70.0f), v_clamp(fma(fabs(n), (vfloat)(-14.0f), (vfloat)(0.8f)), (vfloat)(0.0f), (vfloat)(1.0f)));
    flesh = paint(flesh, (vfloat)(-95.0f), inside(-skin - fat_end, 0.7f));
    flesh = paint(flesh, (vfloat)(35.0f), inside(-skin - 2.0f, per_mm));
    vfloat hu = paint((vfloat)(-1000.0f), flesh, inside(skin, 0.6f * per_mm));

    vfloat cavity = body_distance(anatomy, CLVR_CAVITY, folded);
    vfloat orbit = body_distance(anatomy, CLVR_ORBIT, folded);
    vfloat air = body_distance(anatomy, CLVR_AIR, folded);

    // The braincase: a wall around the cavity, thinner at the temples, with sutures outside.
    vfloat wall = fma(noise(p, 1.0f / 30.0f, key + 5), (vfloat)(1.5f),
                      fma(ramp(folded.x, 48.0f, 60.0f) * ramp(p.z, 62.0f, 40.0f), (vfloat)(-2.2f), (vfloat)(6.0f)));
    vfloat vault = cavity - wall;
    vmask outside = v_lt(fabs(vault), (vfloat)(4.0f));
    if (v_any(outside)) vault = v_select(outside, fma(suture(p, key + 6), (vfloat)(1.1f), vault), vault);
    vault = v_select(v_lt(p.z, (vfloat)(-22.0f)), (vfloat)(9.0f), vault); // no wall around the spinal canal
    vfloat bone = smooth_min(vault, body_distance(anatomy, CLVR_FACE, folded), 5.0f, 0.05f);
    vfloat socket_wall = v_max(orbit - 2.0f, -66.0f - p.y); // behind the rim
    bone = smooth_min(bone, socket_wall, 3.0f, 1.0f / 12.0f);
    bone = smooth_max(smooth_max(bone, -cavity, 1.0f, 0.25f), -orbit, 2.0f, 0.125f);
    if (v_any(v_lt(bone, (vfloat)(2.0f)))) {
        vfloat spongy = fma(noise(p, 1.0f / 3.3f, key + 7), (vfloat)(420.0f), (vfloat)(480.0f));
        vfloat hard = fma(noise(p, 1.0f / 11.0f, key + 8), (vfloat)(160.0f), (vfloat)(1250.0f));
        hu = paint(hu, paint(hard, spongy, inside(bone + 2.3f, 0.6f)), inside(bone, per_mm));
    }

    vmask eye = v_lt(orbit, (vfloat)(2.0f));
    if (v_any(eye)) {
        vfloat socket = inside(v_max(orbit, skin + 4.0f), per_mm);
        hu = paint(hu, (vfloat)(-85.0f), socket);
        vfloat globe = body_distance(anatomy, CLVR_GLOBE, folded);
        vfloat lens = length3((folded.x - 32.0f) * 0.22f, (p.y + 84.5f) * 0.5f, (p.z - 15.0f) * 0.22f) - 1.0f;
        hu = paint(
            hu, paint(paint((vfloat)(60.0f), (vfloat)(12.0f), inside(globe + 1.6f, per_mm)), (vfloat)(95.0f), inside(lens * 2.0f, per_mm)),
            v_select(eye, inside(globe, per_mm), (vfloat)(0.0f)));
    }
    hu = paint(hu, (vfloat)(-1000.0f), inside(air, per_mm));
    if (has(anatomy, CLVR_STRANDS)) hu = paint(hu, (vfloat)(48.0f), inside(body_distance(anatomy, CLVR_STRANDS, folded), per_mm));
    if (has(anatomy, CLVR_TEETH)) {
        vfloat teeth = body_distance(anatomy, CLVR_TEETH, folded);
        hu = paint(hu, paint((vfloat)(2300.0f), (vfloat)(1500.0f), inside(teeth + 1.3f, per_mm)), inside(teeth, per_mm));
    }
    if (v_any(v_lt(cavity, (vfloat)(2.0f)))) {
        vfloat content = brain(anatomy, p, folded, (vfloat)(9.0f), per_mm, key + 16);
        hu = paint(hu, content, inside(cavity, per_mm));
    }
    if (has(anatomy, CLVR_VESSELS)) hu = paint(hu, (vfloat)(360.0f), inside(body_distance(anatomy, CLVR_VESSELS, p), per_mm));
    return hu;
}

__kernel void phantom(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                      __global const uint* list) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), z0 = (int)get_global_id(2);
    int4 dims = params->dims;
    if (x0 >= dims.x || y0 >= dims.y || z0 >= dims.z) return;
    uint key = params->key0;
    float per_mm = params->origin.w;
    int cell = (z0 / CLVR_CELL_Z * params->cells.y + y0 / CLVR_CELL_Y) * params->cells.x + x0 / CLVR_CELL_X;
    Anatomy anatomy = {parts, start, list, (uint)(cell * CLVR_BODIES), params};

    vint ix = x0 + v_iota;
    Point p = {fma(v_float(ix), (vfloat)(params->spacing.x), (vfloat)(params->origin.x)),
               (vfloat)(fma((float)(y0), params->spacing.y, params->origin.y)),
               (vfloat)(fma((float)(z0), params->spacing.z, params->origin.z))};
    vfloat hu = (vfloat)(-1000.0f);
    vfloat skin = (vfloat)(9.0f);
    if (has(&anatomy, CLVR_SKIN)) {
        // No head is symmetric: a slow bend of space, at most CLVR_BEND mm (see the host's lists).
        vfloat unused;
        p.x = fma(v_sincos_turns(fma(p.z, (vfloat)(0.006f), p.y * 0.004f), &unused), (vfloat)(1.2f), p.x);
        p.z = fma(v_sincos_turns(fma(p.x, (vfloat)(0.005f), (vfloat)(0.1f)), &unused), (vfloat)(0.8f), p.z);
    }
    Point folded = {sqrt(fma(p.x, p.x, (vfloat)(0.04f))), p.y, p.z};
    if (has(&anatomy, CLVR_SKIN)) skin = body_distance(&anatomy, CLVR_SKIN, folded);

    vmask head = v_lt(skin, (vfloat)(2.0f));
    if (v_any(head)) hu = v_select(head, tissue(&anatomy, p, folded, skin, per_mm, key), hu);

    // The scanner's noise: the sum of four bytes of a hash, a deviation of about 9 HU.
    vuint h = scrambled(v_uint_of_int(ix) + (uint)(z0 * dims.y + y0) * 0x9E3779B1u ^ (vuint)(params->key1));
    vuint sum = (h & 255u) + ((h >> 8) & 255u) + ((h >> 16) & 255u) + (h >> 24);
    hu = fma(v_float(sum), (vfloat)(0.0625f), hu - 31.875f);
    vint rounded = v_int(floor(v_clamp(hu, (vfloat)(-1024.0f), (vfloat)(3071.0f)) + 0.5f));

    size_t at = ((size_t)(z0)*dims.y + y0) * dims.x + x0;
    int lanes[CLVR_WIDTH];
    v_store(rounded, lanes);
    for (int k = 0; k < CLVR_WIDTH && x0 + k < dims.x; ++k) out[at + k] = (short)(lanes[k]);
}
