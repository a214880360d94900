// Devices, pictures and statistics that the tests of the renderer share.
#pragma once
#include "host/selftest/scenes.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/trust/trust.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

namespace clvr::testing {

using namespace selftest;

/// The device under test, opened anew: tunables and limits set on it end with it.
inline Device open_device(const std::string& selector = {}) { return open_trusted(select_devices(selector).devices.at(0)); }

/// The device under test, opened once: for tests that set nothing on it. Programs are built once, too.
inline Device& shared_device() {
    static Device* const device = new Device(open_device()); // never destroyed: the driver may be gone by then
    return *device;
}

inline Frame render(const Voxels& v, const Scene& scene, const EnvironmentTables& environment = {}) {
    const PreparedVolume prepared(v);
    return clvr::render({shared_device()}, prepared, scene, environment);
}

/// The demand on closed forms: a relative standard error of at most 0.3 %, and a mean within 4 sigma.
/// `rounding`: relative error of the float sums themselves, which the sigma of nearly noise-free pictures does not know.
inline void expect_mean(const Frame& frame, const std::string& name, double expected, double rounding = 2e-6) {
    const Mean m = image_mean(frame, name);
    EXPECT_LE(m.sigma, 0.003 * std::abs(expected)) << name << ": too few samples for the test";
    EXPECT_NEAR(m.value, expected, 4 * m.sigma + rounding * std::abs(expected))
        << name << ": sigma " << m.sigma << ", off by " << (m.value - expected) / std::max(m.sigma, 1e-30) << " sigma";
}

} // namespace clvr::testing
