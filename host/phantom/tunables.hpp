// What may be tuned of computed volumes.
#pragma once
#include "host/volume/tunables.hpp"

namespace clvr::tunables {

/// Work-items in a group of the kernels that compute volumes.
inline constexpr Tunable phantom_group{
    "phantom_group", AllowedValues::powers_of_two(1, 256), usual_packet_group, {"compute volume"}, {1, 2, 4, 8}, {16, 32, 64, 128, 256}};

} // namespace clvr::tunables
