// A number for devices without double.
#pragma once
#include <array>

namespace clvr {

/// A double as the sum of two floats (kernels/lib/two_floats.clh).
inline std::array<float, 2> two_floats(double v) {
    const auto high = static_cast<float>(v);
    return {high, static_cast<float>(v - high)};
}

} // namespace clvr
