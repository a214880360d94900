// What a camera ray sees where the volume is transparent: the environment, interpolated between its texels, and the key's disc; the mean over four fixed
// positions in the pixel. One work-item a pixel.
#include "lib/camera.clh"
#include "lib/light.clh"
#include "lib/paths.clh"

// Radiance of the environment image between texel centres, columns wrapping around.
static inline Vec3 interpolated_environment(const Light* l, Vec3 dir) {
    __constant RenderParams* p = l->p;
    int w = p->environment_width, h = p->environment_height;
    float x = fma(p->sky.z, dir.x, p->sky.w * dir.y), y = fma(p->sky.z, dir.y, -p->sky.w * dir.x);
    float column = fma(v_atan2_turns(x, y) + 0.5f, (float)w, -0.5f), row = v_clamp(fma(v_acos_half_turns(dir.z), (float)h, -0.5f), 0.0f, (float)(h - 1));
    int c = (int)floor(column), r = v_min((int)row, v_max(h - 2, 0)), below = v_min(r + 1, h - 1);
    float tx = column - (float)c, ty = row - (float)r;
    int left = (c + w) % w, right = (c + 1) % w;
    Vec3 a = vec3_of(l->texel[r * w + left]), b = vec3_of(l->texel[r * w + right]), e = vec3_of(l->texel[below * w + left]), f = vec3_of(l->texel[below * w + right]);
    a = along(a, along(b, a, -1.0f), tx);
    e = along(e, along(f, e, -1.0f), tx);
    return along(a, along(e, a, -1.0f), ty);
}

__kernel void background(LIGHT_ARGS, uint first_pixel, uint pixels, __global float4* out) {
    Light light = LIGHT_HERE;
    uint i = (uint)get_global_id(0);
    if (i >= pixels) return;
    uint2 pixel = pixel_of(first_pixel + i, render->width);
    Vec3 sum = vec3(0.0f, 0.0f, 0.0f), o, d;
    for (int k = 0; k < 4; ++k) {
        camera_ray(render, (float)pixel.x + ((k & 1) ? 0.75f : 0.25f), (float)pixel.y + ((k & 2) ? 0.75f : 0.25f), &o, &d);
        float density;
        Vec3 radiance = light_radiance(&light, d, &density);
        if (render->environment_width > 0) {
            Vec3 disc = along(radiance, environment_radiance(&light, d, &density), -1.0f);
            radiance = along(interpolated_environment(&light, d), disc, 1.0f);
        }
        sum = along(sum, radiance, 0.25f);
    }
    out[i] = (float4)(sum.x, sum.y, sum.z, 0.0f);
}
