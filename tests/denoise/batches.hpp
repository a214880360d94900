// Batches on the device, filled from plain arrays.
#pragma once
#include "host/denoise/neural_grid.hpp"
#include "host/frame/frame.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/trust/trust.hpp"
#include "tests/denoise/golden.hpp"

#include <string>
#include <vector>

namespace clvr::testing {

inline Device test_device() { return open_trusted(select_devices("").devices.front()); }

/// Image n of x [B, H, W, 10] (demodulated radiance, albedo, normal, depth) as a frame.
inline Frame frame_of(const std::vector<double>& x, int height, int width, int n) {
    Frame f;
    f.width = width, f.height = height;
    const std::vector<std::string> names = reference_channels();
    for (const auto& name : names) f.channel(name);
    for (std::size_t i = 0; i < f.pixels(); ++i) {
        const double* p = &x[(n * f.pixels() + i) * 10];
        for (int c = 0; c < 10; ++c) {
            const double v = c < 3 ? p[c] * p[3 + c] : c >= 6 && c < 9 ? 2 * p[c] - 1 : p[c];
            f.channel(names[c])[i] = static_cast<float>(v);
        }
    }
    return f;
}

/// Image n of an array [B, H, W, 3] as a frame's R G B.
inline Frame colours_of(const std::vector<double>& rgb, int height, int width, int n) {
    Frame f;
    f.width = width, f.height = height;
    const char* names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) f.channel(names[c]);
    for (std::size_t i = 0; i < f.pixels(); ++i)
        for (int c = 0; c < 3; ++c) f.channel(names[c])[i] = static_cast<float>(rgb[(n * f.pixels() + i) * 3 + c]);
    return f;
}

inline Model golden_model(const Golden& weights) {
    Model m;
    m.channels = reference_channels();
    m.conv1_weight = weights.floats("conv1.weight");
    m.conv1_bias = weights.floats("conv1.bias");
    m.conv2_weight = weights.floats("conv2.weight");
    m.conv2_bias = weights.floats("conv2.bias");
    return m;
}

/// Planes of image 0 without border as [H, W, channels].
inline std::vector<double> interleaved(NeuralGrid& grid, const Buffer& planes, int channels, int first, int count) {
    const std::size_t pixels = static_cast<std::size_t>(grid.shape().width) * grid.shape().height;
    std::vector<double> all(pixels * count);
    for (int c = 0; c < count; ++c) {
        const std::vector<float> plane = grid.download(planes, channels, 0, first + c);
        for (std::size_t i = 0; i < pixels; ++i) all[i * count + c] = plane[i];
    }
    return all;
}

} // namespace clvr::testing
