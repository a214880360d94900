// What may be tuned of the network and its grids.
#pragma once
#include "runtime/tune/tunables.hpp"

namespace clvr::tunables {

/// Lanes of a vector of pixels: the CPU's native ones.
inline constexpr Tunable conv_width{"conv_width",
                                    AllowedValues::list({1, 4, 8, 16}),
                                    [](const DeviceFacts& d, const Tunables&) {
                                        if (d.type != DeviceType::cpu) return 1;
                                        return d.simulator || d.native_float_width >= 16 ? 16 : d.native_float_width >= 8 ? 8 : 4;
                                    },
                                    {"GuideNet", "slice", "splat"},
                                    {1, 4, 8, 16},
                                    {1, 4, 8, 16},
                                    true};

/// Whether, with vectors of so many lanes, a convolution's sums must fit into 16 vector registers (AVX2, SSE): 2 vectors of 7 channels do,
/// 5 of 5 spill. On two cores of an AMD EPYC with AVX2 that takes 0.55 times the time (datasets/results/live.md).
inline bool few_registers(int width) { return width == 4 || width == 8; }

/// Vectors of a row that a work-item of a convolution takes; by default 2 with few registers, else 5, or 4 where that fills the rows
/// better.
inline constexpr Tunable conv_vectors{
    "conv_vectors",
    AllowedValues::whole(1, 6),
    [](const DeviceFacts& d, const Tunables& set) { return few_registers(value_of(conv_width, d, set)) ? 2 : 5; },
    {"GuideNet"},
    {1, 2, 3, 4, 5, 6},
    {1, 2, 3, 4, 5, 6},
    true};

/// Output channels that a convolution computes at once, at most: they must divide the layer's.
inline constexpr Tunable conv_block{
    "conv_block",
    AllowedValues::whole(1, 10),
    [](const DeviceFacts& d, const Tunables& set) { return few_registers(value_of(conv_width, d, set)) ? 7 : 5; },
    {"GuideNet"},
    {1, 2, 4, 5, 7, 10},
    {1, 2, 4, 5, 7, 10},
    true};

/// Work-items of a convolution's group along a row, and rows. No more along a row than fill it: rows are padded to whole groups.
inline constexpr Tunable conv_group_x{"conv_group_x",
                                      AllowedValues::powers_of_two(1, 128),
                                      [](const DeviceFacts& d, const Tunables& set) { return value_of(conv_width, d, set) == 1 ? 32 : 1; },
                                      {"GuideNet"},
                                      {1, 2, 4},
                                      {8, 16, 32, 64, 128}};
inline constexpr Tunable conv_group_y{"conv_group_y",
                                      AllowedValues::powers_of_two(1, 16),
                                      [](const DeviceFacts&, const Tunables&) { return 4; },
                                      {"GuideNet"},
                                      {1, 2, 4, 8, 16},
                                      {1, 2, 4, 8, 16}};

/// Cells of a grid's column that a work-item of splat gathers, at most all.
inline constexpr Tunable splat_bins{
    "splat_bins", AllowedValues::whole(1, 256),  [](const DeviceFacts& d, const Tunables&) { return d.type == DeviceType::cpu ? 256 : 8; },
    {"splat"},    {1, 2, 4, 8, 16, 32, 64, 256}, {1, 2, 4, 8, 16, 32, 64}};

/// Work-items along a row, in a group of kernels over all pixels.
inline constexpr Tunable pixel_group{"pixel_group",
                                     AllowedValues::powers_of_two(1, 256),
                                     [](const DeviceFacts& d, const Tunables& set) { return value_of(conv_width, d, set) == 1 ? 32 : 4; },
                                     {"slice"},
                                     {1, 2, 4, 8, 16},
                                     {8, 16, 32, 64}};

/// Pixels of the rows that go through GuideNet at once: its layers are kept for those alone.
inline constexpr Tunable band_pixels{
    "band_pixels",       AllowedValues::powers_of_two(1, 1 << 24),      [](const DeviceFacts&, const Tunables&) { return 1 << 19; },
    {"denoise a frame"}, {1 << 16, 1 << 17, 1 << 18, 1 << 19, 1 << 20}, {1 << 18, 1 << 19, 1 << 20, 1 << 21}};

/// MiB that a picture takes with its film, at most: beyond that it goes through in tiles, as where memory is short. 1080p just fits at
/// once: 0.7 times the time of 380 MiB, which are four tiles and planes uploaded twice.
inline constexpr Tunable denoise_mib{
    "denoise_mib",       AllowedValues::whole(1, 1 << 20), [](const DeviceFacts&, const Tunables&) { return 600; },
    {"denoise a frame"}, {75, 150, 300, 600, 1200},        {75, 150, 300, 600, 1200}};

} // namespace clvr::tunables
