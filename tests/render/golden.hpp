// The golden scenes (host/selftest/golden.hpp) on the device under test.
#pragma once
#include "host/selftest/golden.hpp"
#include "tests/render/scenes.hpp"

namespace clvr::testing {

/// The picture of a golden scene on a device with some tunables set has the golden hash.
inline void expect_golden(const std::string& name, const std::map<std::string, int>& tunables = {}) {
    Device device = open_device();
    std::string what = name;
    for (const auto& [tunable, value] : tunables) {
        device.set_tunable(tunable, value);
        what += " " + tunable + "=" + std::to_string(value);
    }
    EXPECT_EQ(pixel_hash(render_golden(name, {device})), golden_hashes.at(name)) << what;
}

/// The same in `pools` buffers, forced by the greatest allocation.
inline void expect_golden_in_pools(const std::string& name, int pools, const std::string& max_alloc) {
    const ScopedVariable limit("CLVR_MAX_ALLOC", max_alloc);
    Device device = open_device();
    device.set_tunable("wave_paths", 1 << 15); // whose state fits, too
    const Stage stage(golden_volume().voxels, golden_scene(name));
    ASSERT_EQ(device_layout(device, stage.classified).pools, pools);
    EXPECT_EQ(pixel_hash(render_golden(name, {device})), golden_hashes.at(name)) << pools << " pools";
}

/// The same without features, whose light alone would not fit, against the device without that limit.
inline void expect_paths_in_pools(const std::string& name, int pools, const std::string& max_alloc) {
    Scene scene = golden_scene(name);
    scene.features = false;
    const Frame whole = clvr::render({shared_device()}, golden_volume(), scene);
    const ScopedVariable limit("CLVR_MAX_ALLOC", max_alloc);
    Device device = open_device();
    device.set_tunable("wave_paths", 1 << 15);
    const Stage stage(golden_volume().voxels, scene);
    ASSERT_EQ(device_layout(device, stage.classified).pools, pools);
    EXPECT_EQ(pixel_hash(clvr::render({device}, golden_volume(), scene)), pixel_hash(whole)) << pools << " pools";
}

} // namespace clvr::testing
