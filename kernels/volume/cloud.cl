// A smooth field such as a spray of fuel that burns: soft blobs in space that turbulence bends, over the whole range of values. Blobs from
// host/phantom/cloud.cpp.
#include "lib/solids.clh"

__kernel void cloud(__global short* out, __constant PhantomParams* params, __global const PhantomPart* parts, __global const uint* start,
                    __global const uint* list, int first_slice, int slices) {
    int x0 = (int)get_global_id(0) * CLVR_WIDTH, y0 = (int)get_global_id(1), slice = (int)get_global_id(2);
    if (x0 >= params->dims.x || y0 >= params->dims.y || slice >= slices) return;
    MadePacket m = made_packet(params, x0, y0, slice, first_slice);
    start += m.cell;
    uint key = params->key0;

    // Octaves of noise bend space, by less than params->far mm.
    Vec3 p = m.p;
    vfloat eddy = (vfloat)(0.0f);
    for (int octave = 0; octave < 3; ++octave) {
        float period = 26.0f / (float)(1 << octave), bend = 7.0f / (float)(1 << octave);
        uint k = key + 8u * (uint)(octave);
        p.x = fma(noise(m.p, period, k), (vfloat)(bend), p.x);
        p.y = fma(noise(m.p, period, k + 1u), (vfloat)(bend), p.y);
        vfloat n = noise(m.p, period, k + 2u);
        p.z = fma(n, (vfloat)(bend), p.z);
        eddy = fma(n, (vfloat)(1.0f / (float)(1 << octave)), eddy);
    }
    vfloat density = body_density(0, parts, start, list, p) * v_max(fma(eddy, (vfloat)(0.7f), (vfloat)(1.0f)), (vfloat)(0.0f));
    // Saturates, as light that is taken up.
    store_made(params, &m, fma(v_exp(-density), (vfloat)(-4095.0f), (vfloat)(3071.0f)), 0.3f, slice, out);
}
