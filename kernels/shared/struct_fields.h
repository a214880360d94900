// Every struct that C++ and OpenCL C share with every field, for the self-test to compare where both compilers put them: CLVR_STRUCT(type),
// then CLVR_FIELD(type, field) for each field in order.
#ifndef CLVR_SHARED_STRUCT_FIELDS_H
#define CLVR_SHARED_STRUCT_FIELDS_H
#include "shared/denoise_params.h"
#include "shared/filter_params.h"
#include "shared/light_params.h"
#include "shared/phantom.h"
#include "shared/render_params.h"
#include "shared/volume_params.h"

#define CLVR_EACH_STRUCT_AND_FIELD                                                                                                         \
    CLVR_STRUCT(VolumeParams)                                                                                                              \
    CLVR_FIELD(VolumeParams, last)                                                                                                         \
    CLVR_FIELD(VolumeParams, cells)                                                                                                        \
    CLVR_FIELD(VolumeParams, bricks)                                                                                                       \
    CLVR_FIELD(VolumeParams, coarse)                                                                                                       \
    CLVR_FIELD(VolumeParams, box_low)                                                                                                      \
    CLVR_FIELD(VolumeParams, box_high)                                                                                                     \
    CLVR_FIELD(VolumeParams, plane)                                                                                                        \
    CLVR_FIELD(VolumeParams, to_index)                                                                                                     \
    CLVR_FIELD(VolumeParams, to_normal)                                                                                                    \
    CLVR_FIELD(VolumeParams, extinction)                                                                                                   \
    CLVR_FIELD(VolumeParams, surface_scale)                                                                                                \
    CLVR_FIELD(VolumeParams, shading)                                                                                                      \
    CLVR_FIELD(VolumeParams, pad)                                                                                                          \
    CLVR_STRUCT(RenderParams)                                                                                                              \
    CLVR_FIELD(RenderParams, eye)                                                                                                          \
    CLVR_FIELD(RenderParams, right)                                                                                                        \
    CLVR_FIELD(RenderParams, up)                                                                                                           \
    CLVR_FIELD(RenderParams, forward)                                                                                                      \
    CLVR_FIELD(RenderParams, key)                                                                                                          \
    CLVR_FIELD(RenderParams, key_right)                                                                                                    \
    CLVR_FIELD(RenderParams, key_up)                                                                                                       \
    CLVR_FIELD(RenderParams, key_radiance)                                                                                                 \
    CLVR_FIELD(RenderParams, head_irradiance)                                                                                              \
    CLVR_FIELD(RenderParams, sky)                                                                                                          \
    CLVR_FIELD(RenderParams, key0)                                                                                                         \
    CLVR_FIELD(RenderParams, key1)                                                                                                         \
    CLVR_FIELD(RenderParams, width)                                                                                                        \
    CLVR_FIELD(RenderParams, height)                                                                                                       \
    CLVR_FIELD(RenderParams, environment_width)                                                                                            \
    CLVR_FIELD(RenderParams, environment_height)                                                                                           \
    CLVR_FIELD(RenderParams, bounces)                                                                                                      \
    CLVR_FIELD(RenderParams, phase_g)                                                                                                      \
    CLVR_FIELD(RenderParams, step)                                                                                                         \
    CLVR_FIELD(RenderParams, depth_near)                                                                                                   \
    CLVR_FIELD(RenderParams, depth_scale)                                                                                                  \
    CLVR_FIELD(RenderParams, pad)                                                                                                          \
    CLVR_STRUCT(KeyLight)                                                                                                                  \
    CLVR_FIELD(KeyLight, direction)                                                                                                        \
    CLVR_FIELD(KeyLight, right)                                                                                                            \
    CLVR_FIELD(KeyLight, up)                                                                                                               \
    CLVR_FIELD(KeyLight, irradiance)                                                                                                       \
    CLVR_STRUCT(SkyGrid)                                                                                                                   \
    CLVR_FIELD(SkyGrid, corners)                                                                                                           \
    CLVR_FIELD(SkyGrid, log2_edge)                                                                                                         \
    CLVR_FIELD(SkyGrid, voxel)                                                                                                             \
    CLVR_STRUCT(GridLevel)                                                                                                                 \
    CLVR_FIELD(GridLevel, offset)                                                                                                          \
    CLVR_FIELD(GridLevel, pixels)                                                                                                          \
    CLVR_FIELD(GridLevel, codes)                                                                                                           \
    CLVR_FIELD(GridLevel, rows)                                                                                                            \
    CLVR_FIELD(GridLevel, columns)                                                                                                         \
    CLVR_FIELD(GridLevel, depth)                                                                                                           \
    CLVR_FIELD(GridLevel, inverse_codes)                                                                                                   \
    CLVR_FIELD(GridLevel, slope)                                                                                                           \
    CLVR_FIELD(GridLevel, reciprocal)                                                                                                      \
    CLVR_FIELD(GridLevel, half_pixel)                                                                                                      \
    CLVR_STRUCT(DenoiseParams)                                                                                                             \
    CLVR_FIELD(DenoiseParams, width)                                                                                                       \
    CLVR_FIELD(DenoiseParams, height)                                                                                                      \
    CLVR_FIELD(DenoiseParams, row)                                                                                                         \
    CLVR_FIELD(DenoiseParams, plane)                                                                                                       \
    CLVR_FIELD(DenoiseParams, pad)                                                                                                         \
    CLVR_FIELD(DenoiseParams, levels)                                                                                                      \
    CLVR_FIELD(DenoiseParams, cells)                                                                                                       \
    CLVR_FIELD(DenoiseParams, guide_scale)                                                                                                 \
    CLVR_FIELD(DenoiseParams, level)                                                                                                       \
    CLVR_STRUCT(SourceParams)                                                                                                              \
    CLVR_FIELD(SourceParams, beauty)                                                                                                       \
    CLVR_FIELD(SourceParams, albedo)                                                                                                       \
    CLVR_FIELD(SourceParams, opacity)                                                                                                      \
    CLVR_FIELD(SourceParams, target)                                                                                                       \
    CLVR_FIELD(SourceParams, known)                                                                                                        \
    CLVR_FIELD(SourceParams, channels)                                                                                                     \
    CLVR_FIELD(SourceParams, exposure)                                                                                                     \
    CLVR_FIELD(SourceParams, ceiling)                                                                                                      \
    CLVR_FIELD(SourceParams, albedo_floor)                                                                                                 \
    CLVR_FIELD(SourceParams, noise)                                                                                                        \
    CLVR_STRUCT(LightPlanes)                                                                                                               \
    CLVR_FIELD(LightPlanes, noisy)                                                                                                         \
    CLVR_FIELD(LightPlanes, key)                                                                                                           \
    CLVR_FIELD(LightPlanes, sky)                                                                                                           \
    CLVR_FIELD(LightPlanes, albedo)                                                                                                        \
    CLVR_FIELD(LightPlanes, opacity)                                                                                                       \
    CLVR_STRUCT(FilterParams)                                                                                                              \
    CLVR_FIELD(FilterParams, width)                                                                                                        \
    CLVR_FIELD(FilterParams, height)                                                                                                       \
    CLVR_FIELD(FilterParams, row)                                                                                                          \
    CLVR_FIELD(FilterParams, plane)                                                                                                        \
    CLVR_FIELD(FilterParams, pad)                                                                                                          \
    CLVR_FIELD(FilterParams, radius)                                                                                                       \
    CLVR_FIELD(FilterParams, step)                                                                                                         \
    CLVR_FIELD(FilterParams, spatial)                                                                                                      \
    CLVR_FIELD(FilterParams, feature)                                                                                                      \
    CLVR_FIELD(FilterParams, colour)                                                                                                       \
    CLVR_STRUCT(PhantomPart)                                                                                                               \
    CLVR_FIELD(PhantomPart, center)                                                                                                        \
    CLVR_FIELD(PhantomPart, a)                                                                                                             \
    CLVR_FIELD(PhantomPart, b)                                                                                                             \
    CLVR_FIELD(PhantomPart, c)                                                                                                             \
    CLVR_FIELD(PhantomPart, blend)                                                                                                         \
    CLVR_FIELD(PhantomPart, quarter)                                                                                                       \
    CLVR_FIELD(PhantomPart, sign)                                                                                                          \
    CLVR_FIELD(PhantomPart, kind)                                                                                                          \
    CLVR_STRUCT(PhantomParams)                                                                                                             \
    CLVR_FIELD(PhantomParams, dims)                                                                                                        \
    CLVR_FIELD(PhantomParams, cells)                                                                                                       \
    CLVR_FIELD(PhantomParams, origin)                                                                                                      \
    CLVR_FIELD(PhantomParams, spacing)                                                                                                     \
    CLVR_FIELD(PhantomParams, far)                                                                                                         \
    CLVR_FIELD(PhantomParams, key0)                                                                                                        \
    CLVR_FIELD(PhantomParams, key1)                                                                                                        \
    CLVR_FIELD(PhantomParams, opened)                                                                                                      \
    CLVR_FIELD(PhantomParams, pad)
#endif
