// What may be tuned of training, beside the network (host/denoise/tunables.hpp).
#pragma once
#include "runtime/tune/tunables.hpp"

namespace clvr::tunables {

/// Pixels of the patches on the device at once, at most: less where memory is short. 65536 keep a CPU's caches (8 % faster than 8 times as
/// many) and are enough to share between its cores; a large GPU is only filled by millions (about 500 bytes each).
inline constexpr Tunable micro_pixels{"micro_pixels",
                                      AllowedValues::whole(1, 1 << 26),
                                      [](const DeviceFacts& d, const Tunables&) { return d.type == DeviceType::cpu ? 1 << 16 : 1 << 22; },
                                      {"training step"},
                                      {1 << 15, 1 << 16, 1 << 17, 1 << 18, 1 << 19, 1 << 20, 1 << 22},
                                      {1 << 18, 1 << 19, 1 << 20, 1 << 22, 1 << 23},
                                      true};

/// Output channels that a work-item of weight_gradient takes, at most: they must divide the layer's.
inline constexpr Tunable gradient_block{"gradient_block",
                                        AllowedValues::whole(1, 20),
                                        [](const DeviceFacts& d, const Tunables&) { return d.type == DeviceType::cpu ? 5 : 10; },
                                        {"training step"},
                                        {4, 5, 10, 20},
                                        {4, 5, 10, 20}};

} // namespace clvr::tunables
