// Two devices, the second of which has faults.
#pragma once
#include "tests/runtime/scoped.hpp"
#include "tests/runtime/two_devices.hpp"
#include "tests/runtime/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace clvr::testing {

/// Two parts of the device under test, whose second one (or `part`) has the fault, or both (part 0). `delay_ms`: of each launch of the
/// other one, so that the faulty one has its share of the work for certain. Empty where the device cannot be divided.
inline std::vector<Device> faulty_devices(const std::string& fault, int part = 2, int delay_ms = 0) {
    const DeviceFacts root = select_devices("").devices.at(0);
    if (root.sub_devices != 0 || root.max_sub_devices < 2) return {};
    std::string faults = fmt::format("{}@{}{}", fault, root.index, part ? fmt::format(".{}", part) : "");
    if (delay_ms > 0) faults += fmt::format(",delay:{}@{}.{}", delay_ms, root.index, 3 - part);
    const ScopedVariable variable("CLVR_FAULT", faults);
    return open_two_devices();
}

inline long lines_of(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

} // namespace clvr::testing
