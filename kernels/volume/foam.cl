// Foam, torn by turbulence: the walls between the cells of scattered points (S. Worley, "A cellular texture basis function", 1996) in space that fractal
// noise (K. Perlin) bends; in Hounsfield units, with nothing beyond a ball.
#include "lib/scattered_points.clh"

#define PERIOD 11.0f // of the points' lattice [mm]

__kernel void foam(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                   __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell;
    uint key = params->key0;

    vfloat hu = (vfloat)(-1000.0f);
    vfloat ball = body_distance(0, params->far[0], parts, start, list, m.p);
    vmask near = v_lt(ball, (vfloat)(8.0f));
    if (v_any(near)) {
        // Octaves of noise bend space, more towards the top.
        vfloat strength = ramp(m.p.z, -30.0f, 45.0f) * 9.0f;
        Vec3 p = m.p;
        vfloat swirl = (vfloat)(0.0f);
        for (int octave = 0; octave < 4; ++octave) {
            float period = 28.0f / (float)(1 << octave), share = 1.0f / (float)(1 << octave);
            vfloat n = noise(m.p, period, key + 8u * (uint)(octave));
            p.x = fma(n * share, strength, p.x);
            p.y = fma(noise(m.p, period, key + 8u * (uint)(octave) + 1u) * share, strength, p.y);
            p.z = fma(noise(m.p, period, key + 8u * (uint)(octave) + 2u) * share, strength, p.z);
            swirl = fma(fabs(n), (vfloat)(share), swirl);
        }
        vfloat thick = fma(ramp(m.p.z, 45.0f, -45.0f), (vfloat)(0.5f), (vfloat)(0.45f)); // half a wall [mm]
        NearestPoints near_points = nearest_points(scaled(p, (vfloat)(1.0f / PERIOD)), key + 64u);
        vfloat wall = fma(near_points.second - near_points.first, (vfloat)(0.5f * PERIOD), -thick); // 0 apart: on a wall
        vfloat shape = v_max(wall, fma(swirl, (vfloat)(7.0f), ball));
        hu = v_select(near, paint(hu, fma(swirl, (vfloat)(520.0f), (vfloat)(60.0f)), inside(shape, params->origin.w)), hu);
    }
    store_made(params, &m, hu, 1.0f, slice, out);
}
