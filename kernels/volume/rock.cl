// A drill core of porous rock, in Hounsfield units: rounded grains of two sizes, of three minerals, between them connected pores full of air.
#include "lib/scattered_points.clh"

// Distance to the surface of grains around scattered points `period` mm apart: balls of different sizes, flattened where they meet, `gap` mm apart there.
static inline vfloat grain_distance(NearestPoints n, float period, vfloat gap) {
    vfloat radius = fma(component(n.hash >> 7), (vfloat)(0.09f * period), (vfloat)(0.56f * period));
    vfloat ball = fma(n.first, (vfloat)(period), -radius);
    return smooth_max(ball, fma(n.first - n.second, (vfloat)(0.5f * period), 0.5f * gap), 0.6f, 1.0f / 2.4f);
}

// Quartz, feldspar with lamellae, or a heavy mineral, as a grain's hash has it.
static inline vfloat mineral_hu(vuint hash, Vec3 p, uint key) {
    vuint kind = scrambled(hash ^ 0x2545F491u);
    vfloat share = v_float(kind >> 16) * (1.0f / 65536.0f), unused;
    Vec3 across = vec3(component(kind), component(kind >> 10), (vfloat)(0.4f));
    vfloat lamella = v_clamp(v_sincos_turns(inner3(across, p) * 0.8f, &unused) * 3.0f, (vfloat)(-1.0f), (vfloat)(1.0f));
    vfloat quartz = fma(noise(p, 6.0f, key), (vfloat)(90.0f), (vfloat)(950.0f));
    vfloat feldspar = fma(lamella, (vfloat)(90.0f), (vfloat)(1500.0f));
    vfloat heavy = fma(noise(p, 1.5f, key + 1), (vfloat)(200.0f), (vfloat)(2600.0f));
    return v_select(v_lt(share, (vfloat)(0.6f)), quartz, v_select(v_lt(share, (vfloat)(0.9f)), feldspar, heavy));
}

__kernel void rock(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                   __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell;
    uint key = params->key0;

    vfloat hu = (vfloat)(-1000.0f);
    vfloat core = body_distance(0, params->far[0], parts, start, list, m.p);
    vmask near = v_lt(core, (vfloat)(2.0f));
    if (v_any(near)) {
        // Beds, tilted, in which the grains are packed more or less densely.
        vfloat bed = noise(vec3(m.p.x * 0.15f, m.p.y * 0.15f, fma(m.p.x, (vfloat)(0.25f), m.p.z)), 16.0f, key);
        Vec3 p = vec3(fma(noise(m.p, 22.0f, key + 1), (vfloat)(3.0f), m.p.x), fma(noise(m.p, 22.0f, key + 2), (vfloat)(3.0f), m.p.y), m.p.z);
        NearestPoints coarse = nearest_points(scaled(p, (vfloat)(1.0f / 9.0f)), key + 3), fine = nearest_points(scaled(p, (vfloat)(1.0f / 3.5f)), key + 4);
        vfloat gap = fma(bed, (vfloat)(-0.8f), (vfloat)(0.15f)), rough = noise(p, 1.1f, key + 5);
        vfloat large = fma(rough, (vfloat)(0.2f), grain_distance(coarse, 9.0f, gap));
        vfloat small = fma(ramp(bed, 0.15f, -0.15f), (vfloat)(2.0f), grain_distance(fine, 3.5f, gap * 0.5f));
        vmask of_large = v_lt(large, small);
        vfloat mineral = mineral_hu(v_select(of_large, coarse.hash, fine.hash), p, key + 6);
        vfloat grain = v_max(v_min(large, small), core);
        hu = v_select(near, paint(hu, mineral, inside(grain, params->origin.w)), hu);
    }
    store_made(params, &m, hu, 2.5f, slice, out);
}
