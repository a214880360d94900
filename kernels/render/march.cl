// The marcher: noise-free features, emission-absorption (dvr) or maximum intensity (mip) along fixed rays. One work-item a packet of pixels.
//
// Samples of ray r of R in a pixel lie on its own lattice t0 + (k + (r + 1/2) / R) step: the rays' lattices lie between each other, and what one of them makes of
// a surface, depending on where it meets it, evens out. (On one lattice, smooth surfaces had rings, like wood.) Cells without extinction are skipped in k, so
// skipping never moves a lattice.
// Weights w = T (1 - exp(-sigma step)); a ray ends at T < 1e-4. Sums run over CLVR_RAYS fixed positions in the pixel and are divided once.
#include "lib/feature_pixels.clh"
#include "lib/seek.clh"

// 0 features, 1 dvr, 2 mip
#ifndef CLVR_MARCH
#define CLVR_MARCH 0
#endif
// 1: features with the sums of direct light
#ifndef CLVR_LIT
#define CLVR_LIT 0
#endif
#if CLVR_LIT
#include "lib/light_sums.clh"
#define SUM_ARGS __global const float *lobe, __constant KeyLight *keys, __global float *sums,
#else
#define SUM_ARGS
#endif

#define LEAST_OPACITY 0.00390625f // features of pixels below 1/256 are constants

#define END_TRANSMITTANCE 1e-4f

typedef struct {
    vfloat weight, depth, depth2, half_depth, peak; // sums of w, w d, w d^2, depth of T = 1/2; greatest stored value
    Vec3 color, normal;                             // sums of w c, w n
    vmask met;                                      // lanes with a visible sample
#if CLVR_LIT
    __global const float* lobe;
    __constant KeyLight* keys;
    LightSums lit; // of the ray
#endif
} MarchSums;

static inline Vec3 add_where(vmask m, Vec3 sum, Vec3 v, vfloat w) {
    return vec3(v_select(m, fma(w, v.x, sum.x), sum.x), v_select(m, fma(w, v.y, sum.y), sum.y), v_select(m, fma(w, v.z, sum.z), sum.z));
}

// Unit normal turned against the ray; 0 where the gradient is 0. *steepness: the gradient's length.
static inline Vec3 facing_normal(const Volume* vol, Vec3 p, Vec3 dir, vfloat* steepness) {
    Vec3 g = world_gradient(vol, p);
    *steepness = sqrt(inner3(g, g));
    vfloat s = 1.0f / v_select(v_gt(*steepness, (vfloat)(0.0f)), *steepness, (vfloat)(1.0f));
    return scaled(g, v_select(v_gt(inner3(g, dir), (vfloat)(0.0f)), -s, s));
}

#if CLVR_LIT
// Where a ray's transmittance falls to `goal`, within two steps of where it begins (else `place`): there it may grow from nothing to all within one step, and
// what midpoints of steps say of it swings with the lattice, as rings in the light of smooth surfaces. Walked by quarters of a step, from half a step before.
#define NEAR_BEGIN 10
static inline vfloat place_near_begin(const Volume* vol, __global const float* coarse, const Ray* ray, const WeightCurve* curve, vfloat entry, vfloat goal,
                                      vmask lanes, float step, vfloat place) {
    float quarter = 0.25f * step, rate = -vol->p->extinction * quarter;
    vfloat t = v_max(fma((vfloat)(step), (vfloat)(-0.5f), curve->begin), entry), left = (vfloat)(1.0f);
#pragma nounroll
    for (int n = 0; n < NEAR_BEGIN && v_any(lanes); ++n) {
        Vec3 p = along(ray->o, ray->d, fma((vfloat)(quarter), (vfloat)(0.5f), t));
        Int3 i = clamp_position(vol->p, &p);
        vmask visible = v_gt(v_gather(coarse, coarse_index(vol->p, cell_of(i, vol->p->coarse.w))), (vfloat)(0.0f)); // else its brick may be absent
        vfloat opacity = v_select(visible, opacity_of(vol, stored_value_in(vol, p, i)), (vfloat)(0.0f));
        vfloat lost = fma(-left, v_exp(opacity * rate), left), passed = left - lost;
        vmask here = lanes & v_le(passed, goal);
        place = v_select(here, fma((left - goal) / v_max(lost, (vfloat)(1e-12f)), (vfloat)(quarter), t), place);
        lanes &= v_not(here);
        left = passed, t += quarter;
    }
    return place;
}
#endif

// `number`: of the ray among the pixel's.
static inline void march_ray(const Volume* vol, __global const float* coarse, __constant RenderParams* render, int number, Vec3 pos_index, Vec3 dir_world,
                             vmask lanes, MarchSums* sums) {
    Ray ray = make_ray(vol->p, pos_index, dir_world);
    float step = render->step;
    vfloat t0, t1, t, half_depth = (vfloat)(1.0f);
#if CLVR_MARCH != 2
    float rate = -vol->p->extinction * step;
    vfloat transmitted = (vfloat)(1.0f);
#endif
    vmask active = begin_march(vol, &ray, lanes, &t0, &t1);
#if CLVR_LIT
    vfloat entry = t0;
#endif
    t0 = fma((vfloat)(step), (vfloat)(fma((float)number + 0.5f, 1.0f / (float)CLVR_RAYS, -0.5f)), t0); // of the lattice
    vint k = (vint)(0);
#if CLVR_LIT
    sums->lit = no_light();
    WeightCurve curve;
    begin_curve(&curve);
#endif
    for (;;) {
        Int3 i;
        Vec3 p = seek_visible(vol, coarse, &ray, t0, t1, (vfloat)(step), &k, &active, &t, &i);
        if (!v_any(active)) break;
        vfloat stored = stored_value_in(vol, p, i), opacity = opacity_of(vol, stored);
        k += 1;
#if CLVR_MARCH == 2
        vmask seen = active & v_gt(opacity, (vfloat)(0.0f)) & (v_not(sums->met) | v_gt(stored, sums->peak));
        sums->peak = v_select(seen, stored, sums->peak);
        sums->met |= seen;
#else
        vfloat absorbed = v_select(active, 1.0f - v_exp(opacity * rate), (vfloat)(0.0f)), w = transmitted * absorbed;
        vmask seen = v_gt(w, (vfloat)(0.0f));
        if (v_any(seen)) {
            vfloat steepness, depth = (t - render->depth_near) * render->depth_scale;
            Vec3 color = albedo_of(vol, stored), normal = facing_normal(vol, p, dir_world, &steepness);
#if CLVR_MARCH == 1
            // Lit from the eye as far as the sample acts as a surface.
            vfloat lit = fma(surface_chance(vol->p, steepness), fma((vfloat)(-0.8f), 1.0f + inner3(normal, dir_world), (vfloat)(0.0f)), (vfloat)(1.0f));
            color = scaled(color, lit);
#endif
#if CLVR_LIT
            add_to_curve(&curve, seen, t, step, sums->lit.weight, w);
            add_light_sample(&sums->lit, sums->lobe, sums->keys, number, seen, w, dir_world, color, normal, surface_chance(vol->p, steepness),
                             render->phase_g);
#endif
            sums->weight = fma(transmitted, absorbed, sums->weight);
            sums->color = add_where(seen, sums->color, color, w);
            sums->normal = add_where(seen, sums->normal, normal, w);
            sums->depth = fma(w, depth, sums->depth);
            sums->depth2 = fma(w * depth, depth, sums->depth2);
            transmitted = fma(-transmitted, absorbed, transmitted);
            half_depth = v_select(v_lt(half_depth, (vfloat)(1.0f)) | v_gt(transmitted, (vfloat)(0.5f)), half_depth, depth);
            active &= v_ge(transmitted, (vfloat)(END_TRANSMITTANCE));
        }
#endif
    }
#if CLVR_LIT
    vfloat weight = sums->lit.weight, goal = fma(weight, (vfloat)(-light_quantile(number)), (vfloat)(1.0f));
    sums->lit.place = place_near_begin(vol, coarse, &ray, &curve, entry, goal, v_gt(weight, (vfloat)(0.0f)), step, light_place(&curve, weight, number));
#endif
    sums->half_depth += half_depth;
}

// Writes planes of `stride` values, a multiple of 16, at pixel - first_pixel. Features: albedo RGB, normal XYZ, depth, opacity, depth deviation,
// half depth; with CLVR_LIT the rays' LightSums, too, into `sums`. dvr, mip: R G B A.
__kernel void march(VOLUME_ARGS, __global const float* coarse, __constant RenderParams* render, SUM_ARGS uint first_pixel, uint pixels, uint stride,
                    __global float* planes) {
    VOLUME_HERE(vol);
    uint first = (uint)get_global_id(0) * CLVR_WIDTH;
    if (first >= pixels) return;
    vfloat x, y, zero = (vfloat)(0.0f);
    pixel_corners(render, first_pixel + first, &x, &y);
    vmask lanes = v_lt(v_iota + (int)first, (vint)((int)pixels));
    MarchSums s = {zero, zero, zero, zero, zero, {zero, zero, zero}, {zero, zero, zero}, (vmask)(0)
#if CLVR_LIT
                   , lobe, keys, no_light()
#endif
    };
    for (int ray = 0; ray < CLVR_RAYS; ++ray) {
        Vec3 o, d;
        feature_ray(render, x, y, ray, &o, &d);
        march_ray(&vol, coarse, render, ray, o, d, lanes, &s);
#if CLVR_LIT
        store_sums(sums + (uint)ray * CLVR_LIGHT_SUMS(CLVR_KEYS) * stride + first, stride, &s.lit);
#endif
    }
#if CLVR_MARCH != 2
    float share = 1.0f / (float)CLVR_RAYS;
#endif
#if CLVR_MARCH == 0
    vmask seen = v_ge(s.weight * share, (vfloat)(LEAST_OPACITY));
    vfloat divisor = v_select(seen, s.weight, (vfloat)(1.0f)), one = (vfloat)(1.0f);
    vfloat depth = s.depth / divisor, variance = fma(-depth, depth, s.depth2 / divisor);
    vfloat out[CLVR_FEATURE_PLANES] = {v_select(seen, s.color.x / divisor, one),
                                       v_select(seen, s.color.y / divisor, one),
                                       v_select(seen, s.color.z / divisor, one),
                                       v_select(seen, s.normal.x / divisor, zero),
                                       v_select(seen, s.normal.y / divisor, zero),
                                       v_select(seen, s.normal.z / divisor, zero),
                                       v_select(seen, depth, one),
                                       s.weight * share,
                                       v_select(seen, sqrt(v_max(variance, zero)), zero),
                                       v_select(seen, s.half_depth * share, one)};
    int count = CLVR_FEATURE_PLANES;
#elif CLVR_MARCH == 1
    vfloat out[4] = {s.color.x * share, s.color.y * share, s.color.z * share, s.weight * share};
    int count = 4;
#else
    // The peak's place in the transfer function's domain, as grey.
    vfloat grey = v_clamp(table_index(vol.p, s.peak) / (float)CLVR_TABLE_LAST, zero, (vfloat)(1.0f));
    grey = v_select(s.met, grey, zero);
    vfloat out[4] = {grey, grey, grey, v_select(s.met, (vfloat)(1.0f), zero)};
    int count = 4;
#endif
    for (int c = 0; c < count; ++c) store_pixels(planes + (uint)c * stride + first, pixels - first, out[c]);
}
