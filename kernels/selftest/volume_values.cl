// Stored value, opacity, albedo and world gradient at given index positions. One work-item a packet.
#include "lib/volume.clh"

// in: planes x, y, z of `stride` values; out: planes stored value, opacity, red, green, blue, gradient x, y, z.
__kernel void volume_values(VOLUME_ARGS, __global const float* in, __global float* out, uint stride, uint packets) {
    VOLUME_HERE(vol);
    size_t packet = get_global_id(0);
    if (packet >= packets) return;
    size_t at = packet * CLVR_WIDTH;
    Vec3 p = {v_load(in + at), v_load(in + stride + at), v_load(in + 2 * stride + at)};
    vfloat stored = stored_value(&vol, p);
    Vec3 c = albedo_of(&vol, stored), gradient = world_gradient(&vol, p);
    vfloat values[8] = {stored, opacity_of(&vol, stored), c.x, c.y, c.z, gradient.x, gradient.y, gradient.z};
    for (int k = 0; k < 8; ++k) v_store(values[k], out + k * stride + at);
}
