// What may be tuned of kernels that work in packets.
#pragma once
#include "runtime/tune/tunables.hpp"

namespace clvr::tunables {

/// Lanes of a packet: the CPU's native vectors; 1 elsewhere and on simulators.
inline constexpr Tunable packet{"packet",
                                AllowedValues::list({1, 4, 8, 16}),
                                [](const DeviceFacts& d, const Tunables&) {
                                    if (d.type != DeviceType::cpu || d.simulator) return 1;
                                    return d.native_float_width >= 16 ? 16 : d.native_float_width >= 8 ? 8 : 4;
                                },
                                {"path trace", "feature march"},
                                {1, 4, 8, 16},
                                {1, 4, 8, 16},
                                true};

/// Default work-items in a group of a packet kernel. An interpreter keeps what every instruction of a group computed until the group ends
/// (Oclgrind: core/WorkItem.h, m_pool), so its groups have one work-item.
inline int usual_packet_group(const DeviceFacts& d, const Tunables& set) { return value_of(packet, d, set) > 1 || d.simulator ? 1 : 64; }

} // namespace clvr::tunables
