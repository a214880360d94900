// Marches of a stage, and what they should give.
#pragma once
#include "host/render/marcher.hpp"
#include "host/render/pixel_numbers.hpp"
#include "tests/reference/march.hpp"
#include "tests/render/scenes.hpp"

#include <algorithm>

namespace clvr::testing {

/// Values of plane p at the pixel number n: plane(p)[n], numbers as the renderer counts pixels, in 4x4 blocks.
struct Marched {
    std::uint32_t numbers;
    std::vector<float> planes;
    float at(int plane, std::uint32_t number) const { return planes[static_cast<std::size_t>(plane) * numbers + number]; }
};

inline Marched march(Device& device, const Stage& stage, March kind = March::features) {
    const DeviceVolume volume = stage.upload(device);
    const DeviceLights light(device, stage.render, stage.environment);
    Marched m;
    m.numbers = pixel_numbers(stage.scene.width, stage.scene.height);
    m.planes.resize(static_cast<std::size_t>(m.numbers) * march_planes(kind));
    const SkySplit split = split_sky(stage.render, stage.environment);
    const KeyLights keys(device, key_lights(stage.render, split));
    if (kind == March::features) {
        const SkyLight sky(device, volume, split);
        Marcher(device, volume, light, keys, sky, stage.scene.feature_samples).run(0, m.numbers, m.planes, m.numbers, 0);
    } else {
        Marcher(device, volume, light, kind, stage.scene.feature_samples).run(0, m.numbers, m.planes, m.numbers, 0);
    }
    return m;
}

/// Position in the picture of a pixel number, for pictures whose width is a multiple of 4.
inline std::array<int, 2> position(std::uint32_t number, int width) {
    const int block = static_cast<int>(number / 16), blocks = width / 4, inside = static_cast<int>(number % 16);
    return {block % blocks * 4 + inside % 4, block / blocks * 4 + inside / 4};
}

inline reference::MarchScene reference_scene(const Stage& stage) {
    reference::MarchScene s;
    s.voxels = &stage.volume.voxels;
    s.table = &stage.classified.table;
    s.view = resolve_view(stage.scene, {}, false);
    s.width = stage.scene.width, s.height = stage.scene.height, s.rays = stage.scene.feature_samples;
    s.extinction = stage.scene.extinction;
    s.step = stage.render.step;
    s.box = clip_box_index(stage.scene, stage.volume.voxels);
    s.plane = stage.scene.clip_plane;
    return s;
}

/// Magnitude of the opacity's change when the step is halved: mean over the picture and 99th percentile.
struct StepError {
    double mean, percentile;
};

inline StepError step_error(Device& device, Stage& stage, double step) {
    const auto opacity = [&](double mm) {
        stage.render.step = static_cast<float>(mm);
        const Marched m = march(device, stage);
        return std::vector<float>(m.planes.begin() + 7 * m.numbers, m.planes.begin() + 8 * m.numbers);
    };
    const std::vector<float> whole = opacity(step), half = opacity(step / 2);
    std::vector<float> error(whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) error[i] = std::abs(whole[i] - half[i]);
    std::sort(error.begin(), error.end());
    return {mean_of(error), error[error.size() * 99 / 100]};
}

} // namespace clvr::testing
