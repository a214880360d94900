// Direct light of the features, without noise: CLVR_KEYS lights of one direction each by a march towards them, the rest from the grid of sky light. How much
// of a light arrives is looked up at one point of each ray that march.cl summed: where the ray's weight passes a quantile, which differs between the rays of
// a pixel. The point may lie between two samples; a choice among the samples would jump with every small change. One work-item a packet of pixels.
#include "lib/feature_pixels.clh"
#include "lib/harmonics.clh"
#include "lib/light_sums.clh"
#include "lib/seek.clh"

typedef struct {
    __constant KeyLight* keys; // [CLVR_KEYS]
    const SkyGrid* grid;
    __global const float4* sky_light; // [corners * 9] (volume/sky_light.cl)
} DirectLight;

// Number of steps before the step doubles, in the march towards a key: near shadows are sharp.
#define NEAR_STEPS 8

// Transmittance from index position p towards the unit world direction, by midpoints.
static inline vfloat arriving(const Volume* vol, __global const float* coarse, Vec3 p, Vec3 dir, float step, vmask lanes) {
    Ray ray = make_ray(vol->p, p, dir);
    vfloat begin, end, t, depth = (vfloat)(0.0f);
    vmask active = begin_march(vol, &ray, lanes, &begin, &end);
    vfloat near_end = v_min(fma((vfloat)((float)NEAR_STEPS), (vfloat)(step), begin), end);
#pragma nounroll // twice the code is minutes of compiling on rusticl (Mesa 22.3)
    for (int far = 0; far < 2; ++far) {
        float thickness = vol->p->extinction * step;
        vfloat t0 = far ? near_end : begin, t1 = far ? end : near_end;
        vmask inside = active & v_lt(t0, t1);
        vint k = (vint)(0);
        for (;;) {
            Int3 i;
            Vec3 q = seek_visible(vol, coarse, &ray, t0, t1, (vfloat)(step), &k, &inside, &t, &i);
            if (!v_any(inside)) break;
            depth = v_select(inside, fma(opacity_of(vol, stored_value_in(vol, q, i)), (vfloat)(thickness), depth), depth);
            inside &= v_lt(depth, (vfloat)(7.0f)); // e^-7 is below 1/1000
            k += 1;
        }
        active &= v_lt(depth, (vfloat)(7.0f));
        step *= 2.0f;
    }
    return v_exp(-depth);
}

// Component by component between 0 and `most`. (The macros of vec.clh are for packets.)
static inline float3 held(float3 v, float3 most) {
    v = v > (float3)(0.0f) ? v : (float3)(0.0f);
    return v < most ? v : most;
}
static inline float4 not_negative(float4 v) { return v > (float4)(0.0f) ? v : (float4)(0.0f); }

// Sky light at an index position: the corners around it by trilinear weights; near a surface those in front of it count most, as corners inside what is
// opaque are dark (as light probes are weighted by Majercik et al.: "Dynamic diffuse global illumination with ray-traced irradiance fields", JCGT 8(2), 2019).
// `normal`: in cells of the grid, its greatest component 1; `surface`: how far it is one, 0 to 1. Scalar code.
static inline void sky_around(const DirectLight* light, float3 p, float3 normal, float surface, float4* sum) {
    int4 n = light->grid->corners, log2_edge = light->grid->log2_edge;
    float3 edge = (float3)((float)(1 << log2_edge.x), (float)(1 << log2_edge.y), (float)(1 << log2_edge.z)), at = p / edge;
    float3 q = fma(normal, (float3)(0.5f * surface), at), low = floor(q), t;
    low = held(low, (float3)((float)(n.x - 2), (float)(n.y - 2), (float)(n.z - 2))); // an axis has two corners at least
    t = held(q - low, (float3)(1.0f));
    float whole = 0.0f;
    for (int k = 0; k < CLVR_SKY_TERMS; ++k) sum[k] = (float4)(0.0f);
    for (int c = 0; c < 8; ++c) {
        int x = (int)low.x + (c & 1), y = (int)low.y + ((c >> 1) & 1), z = (int)low.z + (c >> 2);
        float w = (c & 1 ? t.x : 1.0f - t.x) * (c & 2 ? t.y : 1.0f - t.y) * (c & 4 ? t.z : 1.0f - t.z);
        float3 away = (float3)((float)x, (float)y, (float)z) - at;
        float length2 = fma(away.x, away.x, fma(away.y, away.y, away.z * away.z)), n2 = fma(normal.x, normal.x, fma(normal.y, normal.y, normal.z * normal.z));
        float facing = fma(away.x, normal.x, fma(away.y, normal.y, away.z * normal.z)) / sqrt(fma(length2, n2, 1e-12f));
        float front = fma(0.5f, facing, 0.5f);
        w *= fma(surface, fma(front, front, -0.98f), 1.0f); // 1 in a medium; (front^2 + 0.02) at a surface
        whole += w;
        __global const float4* of_corner = light->sky_light + (size_t)((z * n.y + y) * n.x + x) * CLVR_SKY_TERMS;
        for (int k = 0; k < CLVR_SKY_TERMS; ++k) sum[k] = fma((float4)(w), of_corner[k], sum[k]);
    }
    float scale = 1.0f / (whole > 1e-6f ? whole : 1e-6f);
    for (int k = 0; k < CLVR_SKY_TERMS; ++k) sum[k] *= scale;
}

// Integrals of m^n / (m + slope) over m in 0..1, n = 1 to 4. A ray that enters a layer at the cosine `slope` to its normal meets light from the cosine m that
// has crossed the layer as well: the share m / (m + slope) of it arrives (Lommel, Seeliger; Chandrasekhar: "Radiative transfer", 1950, section 15).
typedef struct {
    vfloat n1, n2, n3, n4;
} LayerIntegrals;

static inline LayerIntegrals layer_integrals(vfloat slope) {
    vfloat s = v_max(slope, (vfloat)(1e-3f));
    LayerIntegrals i;
    i.n1 = fma(-s, v_log((1.0f + s) / s), (vfloat)(1.0f));
    i.n2 = fma(-s, i.n1, (vfloat)(0.5f)), i.n3 = fma(-s, i.n2, (vfloat)(0.33333333f)), i.n4 = fma(-s, i.n3, (vfloat)(0.25f));
    return i;
}

// Adds a ray's light to *by_key, *by_sky: linear RGB radiance. `keyed`: the ray's sums per key; `number`: of the ray in its pixel.
static inline void add_direct_light(const LightSums* s, __global const float* keyed, uint stride, const DirectLight* light, const Volume* vol,
                                    __global const float* coarse, const Ray* ray, Vec3 dir, int number, __constant RenderParams* render, Vec3* by_key,
                                    Vec3* by_sky) {
    vmask seen = v_gt(s->weight, (vfloat)(0.0f));
    if (!v_any(seen)) return;
    vfloat coherence = sqrt(inner3(s->normal, s->normal)) / v_select(seen, s->weight, (vfloat)(1.0f));
    vfloat layer = v_min(s->weight, (vfloat)(1.0f)) * v_clamp((coherence - 0.5f) * 2.5f, (vfloat)(0.0f), (vfloat)(1.0f));
    Vec3 normal = unit3(s->normal), outward = rotate3(vol->p->to_index, scaled(normal, (vfloat)(light->grid->voxel.x))); // a voxel's length, in index space
    Vec3 from = along(ray->o, ray->d, s->place);
#pragma nounroll
    for (int k = 0; k < CLVR_KEYS; ++k) {
        vfloat arrives = arriving(vol, coarse, from, key_direction(light->keys + k, number), render->step, seen);
        Vec3 irradiance = scaled(vec3_of(light->keys[k].irradiance), v_select(seen, arrives, (vfloat)(0.0f)));
        *by_key = along(*by_key, product(load_keyed(keyed, stride, k), irradiance), (vfloat)(1.0f));
    }

    // A cosine; times `layer`, as a ray that is not stopped has crossed less.
    LayerIntegrals i = layer_integrals(v_max(-inner3(normal, dir), (vfloat)(0.0f)) * layer);
    Vec3 p = along(from, outward, layer);
    float place[3][CLVR_WIDTH], out[3][CLVR_WIDTH], n[3][CLVR_WIDTH], d[3][CLVR_WIDTH], integral[4][CLVR_WIDTH], front[CLVR_WIDTH], sharp[CLVR_WIDTH];
    float on[3][CLVR_WIDTH], in[3][CLVR_WIDTH];
    int lit[CLVR_WIDTH];
    v_store(p.x, place[0]), v_store(p.y, place[1]), v_store(p.z, place[2]);
    int4 log2_edge = light->grid->log2_edge; // outward in cells of the sky grid, its greatest component 1
    Vec3 in_cells = vec3(outward.x / (float)(1 << log2_edge.x), outward.y / (float)(1 << log2_edge.y), outward.z / (float)(1 << log2_edge.z));
    vfloat greatest = v_max(v_max(fabs(in_cells.x), fabs(in_cells.y)), fabs(in_cells.z));
    in_cells = scaled(in_cells, 1.0f / v_max(greatest, (vfloat)(1e-12f)));
    v_store(in_cells.x, out[0]), v_store(in_cells.y, out[1]), v_store(in_cells.z, out[2]);
    v_store(normal.x, n[0]), v_store(normal.y, n[1]), v_store(normal.z, n[2]);
    v_store(dir.x, d[0]), v_store(dir.y, d[1]), v_store(dir.z, d[2]);
    v_store(i.n1, integral[0]), v_store(i.n2, integral[1]), v_store(i.n3, integral[2]), v_store(i.n4, integral[3]);
    v_store(layer, front), v_store(coherence, sharp), v_store(seen, lit);
    float g = render->phase_g;
    for (int l = 0; l < CLVR_WIDTH; ++l) {
        float4 sky[CLVR_SKY_TERMS], reflected = (float4)(0.0f), scattered = (float4)(0.0f);
        if (lit[l]) {
            float term[CLVR_SKY_TERMS], i1 = integral[0][l], i2 = integral[1][l], i3 = integral[2][l], i4 = integral[3][l];
            sky_around(light, (float3)(place[0][l], place[1][l], place[2][l]), (float3)(out[0][l], out[1][l], out[2][l]), front[l], sky);
            // The orders' factors: of a cosine over the layer and over pi, less sharp for normals around a mean; of the layer alone over 4 pi; of Henyey and
            // Greenstein's function around the ray.
            harmonics(n[0][l], n[1][l], n[2][l], term);
            reflected = not_negative(harmonic_sum(sky, term, 2.0f * i2, 2.0f * i3 * sharp[l], fma(3.0f, i4, -i2) * (sharp[l] * sharp[l])));
            float4 before = harmonic_sum(sky, term, 0.5f * i1, 0.5f * i2, 0.25f * fma(3.0f, i3, -i1));
            harmonics(d[0][l], d[1][l], d[2][l], term);
            float4 within = harmonic_sum(sky, term, 1.0f, g, g * g);
            scattered = not_negative(fma((float4)(front[l]), before - within, within));
        }
        on[0][l] = reflected.x, on[1][l] = reflected.y, on[2][l] = reflected.z;
        in[0][l] = scattered.x, in[1][l] = scattered.y, in[2][l] = scattered.z;
    }
    *by_sky = along(*by_sky, product(s->reflected, vec3(v_load(on[0]), v_load(on[1]), v_load(on[2]))), (vfloat)(1.0f));
    *by_sky = along(*by_sky, product(s->scattered, vec3(v_load(in[0]), v_load(in[1]), v_load(in[2]))), (vfloat)(1.0f));
}

// Writes six planes behind those of march over the same pixels, which left its rays' sums in `sums`: radiance by keys RGB, by the sky RGB.
__kernel void direct_light(VOLUME_ARGS, __global const float* coarse, __constant RenderParams* render, __constant KeyLight* keys, SkyGrid sky_grid,
                           __global const float4* sky_light, __global const float* sums, uint first_pixel, uint pixels, uint stride,
                           __global float* planes) {
    VOLUME_HERE(vol);
    uint first = (uint)get_global_id(0) * CLVR_WIDTH;
    if (first >= pixels) return;
    DirectLight light = {keys, &sky_grid, sky_light};
    vfloat x, y, zero = (vfloat)(0.0f);
    pixel_corners(render, first_pixel + first, &x, &y);
    Vec3 by_key = vec3(zero, zero, zero), by_sky = by_key;
    for (int number = 0; number < CLVR_RAYS; ++number) {
        __global const float* of_ray = sums + (uint)number * CLVR_LIGHT_SUMS(CLVR_KEYS) * stride + first;
        LightSums s = load_sums(of_ray, stride);
        Vec3 o, d;
        feature_ray(render, x, y, number, &o, &d);
        Ray ray = make_ray(vol.p, o, d);
        add_direct_light(&s, of_ray, stride, &light, &vol, coarse, &ray, d, number, render, &by_key, &by_sky);
    }
    float share = 1.0f / (float)CLVR_RAYS;
    vfloat out[6] = {by_key.x * share, by_key.y * share, by_key.z * share, by_sky.x * share, by_sky.y * share, by_sky.z * share};
    for (int c = 0; c < 6; ++c) store_pixels(planes + (uint)(CLVR_FEATURE_PLANES + c) * stride + first, pixels - first, out[c]);
}
