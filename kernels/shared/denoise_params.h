// The neural bilateral grid on the device: its planes, its levels, where its input comes from.
#ifndef CLVR_SHARED_DENOISE_PARAMS_H
#define CLVR_SHARED_DENOISE_PARAMS_H
#include "shared/types.h"
CLVR_SHARED_BEGIN

#define CLVR_LEVELS_MAX 8
#define CLVR_BLEND_RADIUS 10 ///< of the window of kernels/denoise/blend_by_variance.cl [pixels]
#define CLVR_FIT_SUMS 11     ///< of a cell's least squares (denoise/light_columns.cl)
#define CLVR_BAND_BLOCK 8    ///< of the loss's blocks (train/bands.cl) [pixels]
#define CLVR_BAND_GROUP 4    ///< of the blocks whose mean is taken off [blocks]
#define CLVR_BAND_WEIGHT 4.0f

/// Blocks along a side of the picture [pixels]; floats in a row of column sums; pixels of the blocks first .. last - 1.
static inline int band_blocks(int side) { return (side + CLVR_BAND_BLOCK - 1) / CLVR_BAND_BLOCK; }
static inline int band_columns(int width) { return (width + 15) / 16 * 16; }
static inline int band_length(int first, int last, int side) {
    return (last * CLVR_BAND_BLOCK < side ? last * CLVR_BAND_BLOCK : side) - first * CLVR_BAND_BLOCK;
}

/// A bilateral grid: `rows` x `columns` x `depth` cells, depth fastest, from cell `offset` of its image's cells on.
typedef struct GridLevel {
    uint offset;              ///< [cells]
    int pixels, codes;        ///< sampling factors: pixels per cell (both ways), codes per cell
    int rows, columns, depth; ///< [cells]
    float inverse_codes;
    float slope;      ///< of the depth coordinate by the guide: DenoiseParams::guide_scale / codes
    uint reciprocal;  ///< 2^32 / (2 pixels), rounded up: mul_hi by it divides by 2 pixels
    float half_pixel; ///< 1 / (2 pixels)
} GridLevel;
CLVR_CHECK_SIZE(GridLevel, 40);

/// Shapes of a batch of equal images. Planes (network input, hidden layer, guides and blending weights, output, target and their gradients)
/// have a border of `pad` zeros: channel c of C, row y, column x of image n is float ((n C + c) plane + (y + pad) row + pad + x); right of
/// the image, zeros up to the end of the row. Pixels (splatted colours and such) are float4 n width height + y width + x.
typedef struct DenoiseParams {
    int width, height; ///< of each image [pixels]
    int row, plane;    ///< [floats]
    int pad;           ///< half the convolution's size
    int levels;        ///< bilateral grids, finest first
    uint cells;        ///< of all levels of an image
    float guide_scale; ///< codes (of 0..255) per unit of a guide
    GridLevel level[CLVR_LEVELS_MAX];
} DenoiseParams;
CLVR_CHECK_SIZE(DenoiseParams, 352);

/// What a channel of the network's input is made of.
enum ChannelKind { CLVR_CHANNEL_PLAIN, CLVR_CHANNEL_RADIANCE, CLVR_CHANNEL_NORMAL, CLVR_CHANNEL_NOISE /* no plane */ };

/// Planes of a film that tell its light, by number: the first of three each, and the opacity of the feature rays.
typedef struct LightPlanes {
    int noisy, key, sky, albedo, opacity;
} LightPlanes;
CLVR_CHECK_SIZE(LightPlanes, 20);

/// Planes of a source image (each width * height floats, no border), by number; -1: absent.
typedef struct SourceParams {
    int beauty, albedo; ///< the first of three
    int opacity;        ///< weight of a pixel; absent: 1
    int target;         ///< the first of three
    int known;          ///< light that is taken off what is splatted: the first of three
    int channels;       ///< of the network's input
    float exposure;     ///< factor of radiance
    float ceiling;      ///< radiance is clamped here after exposure
    float albedo_floor;
    float noise; ///< (samples per pixel)^(-1/2)
} SourceParams;
CLVR_CHECK_SIZE(SourceParams, 40);

CLVR_SHARED_END
#endif
