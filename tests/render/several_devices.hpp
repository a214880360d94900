// A scene that shows when a pixel is wrong.
#pragma once
#include "tests/render/scenes.hpp"
#include "tests/runtime/two_devices.hpp"

namespace clvr::testing {

inline PreparedVolume wavy_volume() {
    return PreparedVolume(volume_of<std::uint8_t>({24, 20, 22}, [](int x, int y, int z) { return (x * 11 + y * 7 + z * 5) % 256; }));
}

inline Scene wavy_scene() {
    Scene s;
    s.volume = "test";
    s.width = 61;
    s.height = 43;
    s.spp = 7;
    s.transfer = uniform_transfer({0.8, 0.5, 0.3});
    s.transfer->points = {{0, {0, 0, 0}, 0}, {100, {1, 0.9, 0.8}, 0.7}, {200, {0, 1, 0}, 0}, {255, {1, 1, 1}, 1}};
    return s;
}

/// All channels, bit for bit.
inline void expect_same(const Frame& a, const Frame& b) {
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (const auto& [name, values] : a.channels) {
        ASSERT_TRUE(b.has(name)) << name;
        EXPECT_EQ(std::memcmp(values.data(), b.at(name).data(), values.size() * sizeof(float)), 0) << name;
    }
}

} // namespace clvr::testing
