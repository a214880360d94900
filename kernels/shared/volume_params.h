// What a kernel needs to know of a volume and its classification.
#ifndef CLVR_SHARED_VOLUME_PARAMS_H
#define CLVR_SHARED_VOLUME_PARAMS_H
#include "shared/types.h"
CLVR_SHARED_BEGIN

/// Index space: voxel centres at integers. "last" is max(n, 2) - 1: an axis of one voxel is stored twice.
typedef struct VolumeParams {
    int4 last;           ///< xyz: greatest voxel index
    int4 cells;          ///< xyz: majorant cells; w: log2 of their edge
    int4 bricks;         ///< xyz: bricks; w: log2 of their edge
    int4 coarse;         ///< xyz: cells of mean opacity; w: log2 of their edge
    float4 box_low;      ///< xyz: lower corner of the (clipped) volume [index]; w: stored value of table entry 0
    float4 box_high;     ///< xyz: upper corner [index]; w: table entries per stored unit
    float4 plane;        ///< clip plane in index space: xyz . p <= w stays; all 0 when there is none
    float4 to_index[3];  ///< rows: world direction [mm] to index direction
    float4 to_normal[3]; ///< rows: index gradient to world gradient [1/mm] (inverse transpose)
    float extinction;    ///< sigma_t at opacity 1 [1/mm]
    float surface_scale; ///< 4 * smallest spacing / width of the visible value interval: p = 1 - exp(-surface_scale |grad|)
                         ///< (host/README.md, "Shading")
    int shading;         ///< 0 auto, 1 phase, 2 gradient
    int pad;
} VolumeParams;
CLVR_CHECK_SIZE(VolumeParams, 224);

CLVR_SHARED_END
#endif
