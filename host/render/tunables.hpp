// What may be tuned of path tracing and marching.
#pragma once
#include "host/volume/tunables.hpp"

#include <algorithm>

namespace clvr::tunables {

/// Work-items in a group of the packet kernels.
inline constexpr Tunable packet_group{"packet_group",     AllowedValues::powers_of_two(1, 256),
                                      usual_packet_group, {"path trace", "feature march"},
                                      {1, 2, 4, 8},       {16, 32, 64, 128, 256}};

/// Packets that a work-item traces one after the other.
inline constexpr Tunable packet_run{"packet_run",
                                    AllowedValues::whole(1, 256),
                                    [](const DeviceFacts& d, const Tunables& set) { return value_of(packet, d, set) == 1 ? 1 : 16; },
                                    {"path trace"},
                                    {1, 4, 8, 16, 32, 64},
                                    {1, 2, 4, 8, 16},
                                    true};

/// Idle lanes at which a packet takes new paths; no more than it has lanes.
inline constexpr Tunable packet_refill{"packet_refill",
                                       AllowedValues::whole(1, 16),
                                       [](const DeviceFacts& d, const Tunables& set) { return std::max(1, value_of(packet, d, set) / 4); },
                                       {"path trace"},
                                       {1, 2, 4, 8, 12, 16},
                                       {1, 2, 4, 8, 12, 16}};

/// Work-items in a group of the kernels of single paths and cells.
inline constexpr Tunable shade_group{"shade_group",
                                     AllowedValues::powers_of_two(1, 256),
                                     [](const DeviceFacts& d, const Tunables&) { return d.simulator ? 1 : 64; },
                                     {"path trace"},
                                     {16, 32, 64, 128, 256},
                                     {16, 32, 64, 128, 256}};

/// Paths in flight at once, at most: less where the picture has fewer or memory is short.
inline constexpr Tunable wave_paths{"wave_paths",
                                    AllowedValues::whole(16, 1 << 24),
                                    [](const DeviceFacts& d, const Tunables&) { return d.type == DeviceType::cpu ? 1 << 16 : 1 << 22; },
                                    {"path trace"},
                                    {1 << 13, 1 << 14, 1 << 15, 1 << 16, 1 << 17, 1 << 18, 1 << 20},
                                    {1 << 15, 1 << 16, 1 << 17, 1 << 18, 1 << 20, 1 << 21, 1 << 22, 1 << 23},
                                    true};

/// Pixels of a tile that a device takes of a picture; by default those of a wave. How tiles are shared depends on the picture and on how
/// many devices there are, so the tuner does not try it.
inline constexpr Tunable tile_pixels{
    "tile_pixels", AllowedValues::whole(16, 1 << 30), [](const DeviceFacts&, const Tunables&) { return 1 << 30; }, {}, {}, {}};

/// Pixels of a launch of the march, at most: less where memory is short.
inline constexpr Tunable march_pixels{"march_pixels",
                                      AllowedValues::whole(16, 1 << 20),
                                      [](const DeviceFacts& d, const Tunables&) { return d.type == DeviceType::cpu ? 1 << 14 : 1 << 16; },
                                      {"feature march"},
                                      {1 << 12, 1 << 14, 1 << 16, 1 << 18},
                                      {1 << 12, 1 << 14, 1 << 16, 1 << 18}};

/// log2 of a brick's edge, of volumes that are not thin.
inline constexpr Tunable brick_log2{"brick_log2",
                                    AllowedValues::whole(2, 7),
                                    [](const DeviceFacts&, const Tunables&) { return 5; },
                                    {"path trace", "feature march"},
                                    {3, 4, 5, 6, 7},
                                    {3, 4, 5, 6, 7},
                                    true};

} // namespace clvr::tunables
