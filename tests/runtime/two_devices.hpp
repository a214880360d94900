// Two devices out of the one under test.
#pragma once
#include "runtime/choose/select.hpp"
#include "runtime/opencl/device.hpp"
#include "runtime/trust/trust.hpp"

#include <vector>

namespace clvr::testing {

/// Two equal parts of the device under test (one context), or where it cannot be divided the device opened twice (two contexts).
inline std::vector<Device> open_two_devices() {
    const DeviceFacts root = select_devices("").devices.at(0);
    std::vector<Device> devices;
    if (root.sub_devices == 0 && root.max_sub_devices >= 2) {
        for (const DeviceFacts& part : divide(root, 2)) devices.push_back(open_trusted(part));
    } else {
        devices = {open_trusted(root), open_trusted(root)};
    }
    return devices;
}

/// The same, opened once: for tests that set nothing on them.
inline const std::vector<Device>& two_devices() {
    static const std::vector<Device>* const devices =
        new std::vector<Device>(open_two_devices()); // never destroyed: the driver may be gone by then
    return *devices;
}

} // namespace clvr::testing
