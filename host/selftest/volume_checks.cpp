// Volumes and light in closed form.
#include "host/selftest/check.hpp"
#include "host/selftest/golden_values.hpp"
#include "host/selftest/scenes.hpp"

#include <fmt/format.h>

namespace clvr::selftest {
namespace {

/// Any scene with an eye and every value between 0 and 255 visible.
Scene seen_from_afar(std::vector<TransferFunction::Point> points) {
    Scene s = plain_scene(8, 1);
    look_along_y(s, {0, 0, 0}, 10);
    s.transfer->points = std::move(points);
    return s;
}

Frame render_on(Device& device, const PreparedVolume& volume, const Scene& scene) { return clvr::render({device}, volume, scene); }

/// Within 4 standard errors and rounding.
std::string compared(bool& ok, double found, double expected, double allowed, const char* what) {
    ok &= std::abs(found - expected) <= allowed; // not so for NaN
    return fmt::format("{} {:.6f} ({:+.1e})", what, found, found - expected);
}

} // namespace

Outcome check_seams(Device& device) {
    constexpr std::size_t points = 2048;
    const Stage stage(volume_of<std::uint8_t>({70, 70, 70}, [](int x, int y, int z) { return x + y + z; }),
                      seen_from_afar({{0, {0.1, 0.2, 0.3}, 0.1}, {255, {0.9, 0.6, 0.4}, 1}}));
    std::vector<float> line(3 * points);
    for (std::size_t i = 0; i < points; ++i) {
        const double t = static_cast<double>(i) / (points - 1);
        line[i] = static_cast<float>(69 * t), line[points + i] = static_cast<float>(68.9 - 68 * t);
        line[2 * points + i] = static_cast<float>(0.3 + 67 * t);
    }
    const Buffer in = device.upload(line, "positions");
    const auto values = [&](int log2_edge) {
        const BrickLayout layout =
            brick_layout(stage.volume.voxels, stage.volume.grid, stage.classified.majorants, log2_edge, device.max_alloc_bytes());
        const DeviceVolume volume = stage.upload(device, layout);
        const int width = packet_width(device);
        Defines defines = volume.defines();
        defines["CLVR_WIDTH"] = std::to_string(width);
        Kernel kernel = device.kernel("selftest/volume_values", defines);
        const Buffer out = device.buffer(4 * 8 * points, "values");
        const auto packets = static_cast<std::uint32_t>(points) / static_cast<std::uint32_t>(width);
        device.launch(kernel, {packets}, {1}, {}, volume.arguments(), in, out, static_cast<std::uint32_t>(points), packets);
        return device.download<float>(out, 8 * points);
    };
    const std::vector<float> whole = values(7); // a single brick
    double worst = 0;
    std::size_t differing = 0;
    for (const int log2_edge : {7, 5, 4, 3}) {
        const std::vector<float> found = values(log2_edge);
        for (std::size_t i = 0; i < points; ++i) {
            const double error = std::abs(found[i] - (static_cast<double>(line[i]) + line[points + i] + line[2 * points + i]));
            if (!(error <= worst)) worst = error; // NaN stays
        }
        for (std::size_t i = 0; i < whole.size(); ++i) differing += std::memcmp(&found[i], &whole[i], sizeof(float)) != 0;
    }
    return {worst <= 4e-5 && differing == 0, "error up to 4e-05, the bits of one brick at edges 8, 16, 32",
            fmt::format("error up to {:.0e}, {} values of other bits", worst, differing)};
}

Outcome check_majorants(Device& device) {
    constexpr std::size_t rays = 256;
    // Cells of very different ranges: neighbours along x, y and z do not stand in for each other.
    const Stage stage(volume_of<std::uint8_t>({90, 50, 34},
                                              [](int x, int y, int z) {
                                                  const int cell = (x / 16 * 7 + y / 16 * 3 + z / 16 * 5) % 6;
                                                  return 40 * cell + (x * 11 + y * 7 + z * 5) % 30;
                                              }),
                      seen_from_afar({{0, {1, 1, 1}, 0}, {30, {1, 1, 1}, 0}, {255, {1, 1, 1}, 1}}));
    std::vector<float> in(6 * rays);
    std::uint32_t k = 1;
    const auto uniform = [&] {
        k = k * 1664525u + 1013904223u;
        return static_cast<float>(k >> 8) * 0x1p-24f;
    };
    const float extent[] = {90, 50, 34};
    for (std::size_t i = 0; i < rays; ++i) {
        double length = 0;
        for (int a = 0; a < 3; ++a) {
            in[a * rays + i] = extent[a] * uniform() - 0.5f;
            in[(3 + a) * rays + i] = 2 * uniform() - 1;
            length += static_cast<double>(in[(3 + a) * rays + i]) * in[(3 + a) * rays + i];
        }
        for (int a = 3; a < 6; ++a) in[a * rays + i] = static_cast<float>(in[a * rays + i] / std::sqrt(length));
    }
    const DeviceVolume volume = stage.upload(device);
    const int width = packet_width(device);
    Defines defines = volume.defines();
    defines["CLVR_WIDTH"] = std::to_string(width);
    Kernel kernel = device.kernel("selftest/majorant_values", defines);
    const Buffer rays_in = device.upload(in, "rays"), excess = device.buffer(4 * rays, "excess"), stops = device.buffer(4 * rays, "stops");
    const auto packets = static_cast<std::uint32_t>(rays) / static_cast<std::uint32_t>(width);
    device.launch(kernel, {packets}, {1}, {}, volume.arguments(), rays_in, excess, stops, 1.0f, static_cast<std::uint32_t>(rays), packets);
    float greatest = -1;
    for (const float e : device.download<float>(excess, rays))
        if (!(e <= greatest)) greatest = e; // NaN stays
    int count = 0;
    for (const int n : device.download<std::int32_t>(stops, rays)) count += n;
    return {greatest <= 0 && count == golden_stops, fmt::format("no opacity above its majorant at {} stops", golden_stops),
            fmt::format("greatest excess {:.3g} at {} stops", greatest, count)};
}

Outcome check_slab(Device& device) {
    constexpr double tau = 2;
    const double alpha = 1 - std::exp(-tau);
    const PreparedVolume volume(constant_volume({24, 8, 24}));
    Scene s = plain_scene(24, 64);
    s.transfer = uniform_transfer({0.75, 0.5, 0.25}, 0.5);
    s.extinction = 2 * tau / 8;
    s.bounces = 1;
    s.features = true;
    look_along_y(s, {11.5, 3.5, 11.5}, 12);
    const Frame path = render_on(device, volume, s);
    s.mode = Mode::dvr;
    const Frame dvr = render_on(device, volume, s);
    double marched = 0, shown = 0; // the value that is furthest off
    for (const float a : path.at(channel::opacity))
        if (!(std::abs(a - alpha) <= std::abs(marched - alpha)) || marched == 0) marched = a;
    for (const float r : dvr.at("R"))
        if (!(std::abs(r - 0.75 * alpha) <= std::abs(shown - 0.75 * alpha)) || shown == 0) shown = r;
    const double sigma = std::sqrt(alpha * (1 - alpha) / (static_cast<double>(path.pixels()) * s.spp));
    bool ok = true;
    const std::string found = compared(ok, marched, alpha, 2e-6, "marched") + ", " + compared(ok, shown, 0.75 * alpha, 2e-6, "red") + ", " +
                              compared(ok, mean_of(path.at("A")), alpha, 4 * sigma, "traced");
    return {ok, fmt::format("marched {0:.6f} and red {1:.6f} within 2e-06, traced {0:.6f} within {2:.1e}", alpha, 0.75 * alpha, 4 * sigma),
            found};
}

Outcome check_furnace(Device& device) {
    const PreparedVolume volume(blob(16));
    const Frame f = render_on(device, volume, furnace_scene(Shading::automatic, 0.4, 64));
    bool ok = true;
    std::string found;
    double allowed = 0;
    for (const char* c : {"R", "G", "B"}) {
        const Mean m = image_mean(f, c);
        allowed = std::max(allowed, 4 * m.sigma + 2e-6);
        found += (found.empty() ? "" : ", ") + compared(ok, m.value, 1, std::min(4 * m.sigma + 2e-6, 0.01), c);
    }
    return {ok, fmt::format("mean 1 within {:.1e}", allowed), found};
}

} // namespace clvr::selftest
