// Frames to denoise.
#pragma once
#include "host/denoise/model.hpp"
#include "host/frame/frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace clvr::testing {

/// Channels of a noisy rendering, with smooth and hard features.
inline Frame noisy_frame(int width, int height) {
    Frame f;
    f.width = width, f.height = height;
    std::uint32_t k = 17;
    const auto noise = [&] {
        k = k * 1664525u + 1013904223u;
        return static_cast<float>(k >> 8) / (1 << 24);
    };
    for (const auto& name : reference_channels()) f.channel(name);
    f.channel("A");
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * width + x;
            const float disc =
                std::hypot(x - width / 2.0f, y - height / 2.0f) < 0.4f * static_cast<float>(std::min(width, height)) ? 1.0f : 0.0f;
            f.channel("A")[i] = f.channel("opacity.A")[i] = disc;
            for (const char* c : {"R", "G", "B"}) f.channel(c)[i] = disc * 2 * noise() * noise();
            for (const char* c : {"albedo.R", "albedo.G", "albedo.B"}) f.channel(c)[i] = disc > 0 ? 0.3f + 0.5f * (x / 7 % 2) : 1;
            for (const char* c : {"normal.X", "normal.Y", "normal.Z"}) f.channel(c)[i] = disc * std::sin(0.1f * static_cast<float>(x + y));
            f.channel("depth.Z")[i] = disc > 0 ? static_cast<float>(y) / static_cast<float>(height) : 1;
            const float lit = disc * (x > y ? 0.4f : 0.1f); // a shadow's border, and a sky that is brighter on top
            for (const char* c : {"R", "G", "B"}) {
                f.channel(std::string("light.key.") + c)[i] = lit;
                f.channel(std::string("light.sky.") + c)[i] = disc * (0.3f - 0.2f * static_cast<float>(y) / static_cast<float>(height));
            }
        }
    return f;
}

} // namespace clvr::testing
