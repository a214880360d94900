// Camera, light and transport settings of a frame.
#ifndef CLVR_SHARED_RENDER_PARAMS_H
#define CLVR_SHARED_RENDER_PARAMS_H
#include "shared/types.h"
CLVR_SHARED_BEGIN

#define CLVR_FEATURE_PLANES 10 ///< of the march: albedo RGB, normal XYZ, depth, opacity, depth deviation, half depth

/// Directions are world space; positions of rays are index space. Colours are linear RGB radiance.
typedef struct RenderParams {
    float4 eye;             ///< index position of the eye (of the image plane's centre when orthographic); w: 1 when orthographic
    float4 right;           ///< world: half the image's width to the right, at distance 1 (orthographic: in index space [voxels])
    float4 up;              ///< likewise half the height upwards
    float4 forward;         ///< unit, world
    float4 key;             ///< unit direction towards the key light; w: cosine of its disc's radius (1: a directional light)
    float4 key_right;       ///< with key_up and key an orthonormal frame; w: solid angle of the disc [sr]
    float4 key_up;          ///< w: chance that a light sample is taken from the key
    float4 key_radiance;    ///< radiance of the disc, irradiance when it is directional; w: chance of the headlight
    float4 head_irradiance; ///< of the directional light from behind the camera
    float4 sky;             ///< x, y: radiance x + y z of the environment without image; z, w: cosine, sine of the image's rotation
    uint key0, key1;        ///< key of the random numbers
    int width, height;      ///< [pixels]
    int environment_width, environment_height; ///< [texels], 0: no image
    int bounces;                               ///< greatest number of scattering events, 0: unlimited
    float phase_g;                             ///< Henyey-Greenstein asymmetry
    float step;                                ///< of the march lattice [mm]
    float depth_near, depth_scale;             ///< depth feature = (t - near) * scale
    int pad;
} RenderParams;
CLVR_CHECK_SIZE(RenderParams, 208);

CLVR_SHARED_END
#endif
