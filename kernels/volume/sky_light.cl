// Sky light in the volume: at each corner of a coarse grid, what arrives of the light from CLVR_SKY_DIRECTIONS fixed directions, as spherical harmonics.
// Marches through mean opacities, leaping over what is empty. One work-item a corner, CLVR_WIDTH directions at once.
#include "lib/harmonics.clh"
#include "lib/seek.clh"

#define DARK 12.0f // optical depth behind which no light is looked for

// Whether anything visible lies within two cells of the sky grid around the corner's voxel: elsewhere nobody reads the light. Looks at the first lane.
static inline bool near_something(const Volume* vol, __global const float* coarse, Int3 corner, int4 log2_edge) {
    int at[CLVR_WIDTH];
    v_store(coarse_index(vol->p, cell_of(corner, vol->p->coarse.w)), at);
    float away = -coarse[at[0]] * (float)(1 << vol->p->coarse.w); // along the axis where it is farthest
    return away <= (float)(2 << v_max(v_max(log2_edge.x, log2_edge.y), log2_edge.z));
}

// `direction`, `radiance`: [CLVR_SKY_DIRECTIONS] towards the light; linear RGB times the direction's solid angle. `light`: [corners * 9], x fastest.
__kernel void sky_light(VOLUME_ARGS, __global const float* coarse, SkyGrid grid, __global const float4* direction, __global const float4* radiance,
                        __global float4* light) {
    VOLUME_HERE(vol);
    int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= grid.corners.x || y >= grid.corners.y || z >= grid.corners.z) return;
    light += (size_t)((z * grid.corners.y + y) * grid.corners.x + x) * CLVR_SKY_TERMS;
    int4 log2_edge = grid.log2_edge;
    Vec3 start = vec3((vfloat)((float)(x << log2_edge.x)), (vfloat)((float)(y << log2_edge.y)), (vfloat)((float)(z << log2_edge.z)));
    Int3 voxel = clamp_position(vol.p, &start);
    float4 sum[CLVR_SKY_TERMS];
    for (int k = 0; k < CLVR_SKY_TERMS; ++k) sum[k] = (float4)(0.0f);
    if (near_something(&vol, coarse, voxel, log2_edge)) {
        for (int first = 0; first < CLVR_SKY_DIRECTIONS; first += CLVR_WIDTH) {
            __global const float* d = (__global const float*)(direction + first);
            Vec3 to_light = vec3(v_gather_offset(d, v_iota * 4, 0), v_gather_offset(d, v_iota * 4, 1), v_gather_offset(d, v_iota * 4, 2));
            Ray ray = make_ray(vol.p, start, to_light);
            vfloat t0, t1, t, depth = (vfloat)(0.0f);
            vmask active = begin_march(&vol, &ray, (vmask)(-1), &t0, &t1);
            // Steps of one coarse cell along the axis that the ray runs along most.
            vfloat step = (float)(1 << vol.p->coarse.w) / v_max(v_max(fabs(ray.d.x), fabs(ray.d.y)), fabs(ray.d.z));
            vint k = (vint)(0);
            while (v_any(active)) {
                Int3 i;
                seek_visible(&vol, coarse, &ray, t0, t1, step, &k, &active, &t, &i);
                vfloat mean = v_gather(coarse, coarse_index(vol.p, cell_of(i, vol.p->coarse.w)));
                depth = v_select(active, fma(mean * vol.p->extinction, step, depth), depth);
                k += 1;
                active &= v_lt(depth, (vfloat)(DARK));
            }
            float arrives[CLVR_WIDTH];
            v_store(v_exp(-depth), arrives);
            for (int lane = 0; lane < CLVR_WIDTH; ++lane) {
                float term[CLVR_SKY_TERMS];
                float4 towards = direction[first + lane], comes = arrives[lane] * radiance[first + lane];
                harmonics(towards.x, towards.y, towards.z, term);
                for (int n = 0; n < CLVR_SKY_TERMS; ++n) sum[n] = fma((float4)(term[n]), comes, sum[n]);
            }
        }
    }
    for (int k = 0; k < CLVR_SKY_TERMS; ++k) light[k] = sum[k];
}
