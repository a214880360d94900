#include "host/render/scene_settings.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace clvr {

namespace {

using Ends = SettingRange::Ends;
constexpr double most = std::numeric_limits<double>::max();
constexpr SettingRange any{Ends::inside, -most, most, "a finite number"},
    not_negative{Ends::inside, 0, most, "a finite number of 0 or more"};

} // namespace

bool SettingRange::holds(double value) const {
    if (ends == Ends::alone) return value == low || value == high;
    return std::isfinite(value) && (ends == Ends::inside ? value >= low && value <= high : value > low && value < high);
}

std::string SettingRange::text() const { return expected ? expected : fmt::format("{} to {}", low, high); }

std::string SceneSetting::section() const {
    const std::string all = key;
    const std::size_t dot = all.find('.');
    return dot == all.npos ? "" : all.substr(0, dot);
}

std::string SceneSetting::member_name() const {
    const std::string all = key;
    return all.substr(all.find('.') + 1); // npos + 1 is 0
}

const std::vector<SceneSetting>& scene_settings() {
    static const std::vector<SceneSetting> all{
        {"width", "--size (width)", "", nullptr, +[](Scene& s) -> int& { return s.width; }, {Ends::inside, 1, largest_frame_side}},
        {"height", "--size (height)", "", nullptr, +[](Scene& s) -> int& { return s.height; }, {Ends::inside, 1, largest_frame_side}},
        {"spp",
         "--spp",
         "Output",
         "Samples per pixel: more take longer and give less noise",
         +[](Scene& s) -> int& { return s.spp; },
         {Ends::inside, 1, largest_spp}},
        {"extinction", "--extinction", "Look", "How dense opacity 1 is, in 1/mm [512 / diagonal]",
         +[](Scene& s) -> double& { return s.extinction; }, not_negative},
        {"camera.orthographic", "camera.orthographic", "", nullptr, +[](Scene& s) -> bool& { return s.camera.orthographic; }, {}},
        {"camera.azimuth", "--azimuth", "Camera", "Degrees around the vertical axis; 0 faces a patient, 90 sees the left side",
         +[](Scene& s) -> double& { return s.camera.azimuth; }, any},
        {"camera.elevation",
         "--elevation",
         "Camera",
         "Degrees above the horizon",
         +[](Scene& s) -> double& { return s.camera.elevation; },
         {Ends::inside, -90, 90}},
        {"camera.zoom",
         "--zoom",
         "Camera",
         "Above 1 enlarges",
         +[](Scene& s) -> double& { return s.camera.zoom; },
         {Ends::outside, 0, std::numeric_limits<double>::infinity(), "a finite number above 0"}},
        {"camera.fov",
         "--fov",
         "Camera",
         "Vertical field of view in degrees",
         +[](Scene& s) -> double& { return s.camera.fov; },
         {Ends::outside, 0, 180, "more than 0 and less than 180 degrees"}},
        {"camera.height", "camera.height", "", nullptr, +[](Scene& s) -> double& { return s.camera.height; }, not_negative},
        {"light.level", "--environment", "", nullptr, +[](Scene& s) -> double& { return s.light.level; }, not_negative},
        {"light.image_rotation", "--environment-rotation", "Light", "Degrees by which the image is turned around the vertical axis",
         +[](Scene& s) -> double& { return s.light.image_rotation; }, any},
        {"light.key", "--key", "Light", "Strength of the soft key light [1 under the sky, else 0]",
         +[](Scene& s) -> double& { return s.light.key; }, not_negative},
        {"light.key_azimuth", "--key-azimuth", "Light", "Direction of the key light in degrees, relative to the camera's",
         +[](Scene& s) -> double& { return s.light.key_azimuth; }, any},
        {"light.key_elevation",
         "--key-elevation",
         "Light",
         "Height of the key light in degrees",
         +[](Scene& s) -> double& { return s.light.key_elevation; },
         {Ends::inside, -90, 90}},
        {"light.key_angle", "light.key_angle", "", nullptr, +[](Scene& s) -> double& { return s.light.key_angle; }, {Ends::inside, 0, 180}},
        {"light.headlight", "--headlight", "Light", "Irradiance of a light from the camera",
         +[](Scene& s) -> double& { return s.light.headlight; }, not_negative},
        {"phase_g",
         "--phase-g",
         "Light",
         "Henyey-Greenstein asymmetry, above -1 and below 1",
         +[](Scene& s) -> double& { return s.phase_g; },
         {Ends::outside, -1, 1, "more than -1 and less than 1"}},
        {"bounces",
         "--bounces",
         "Light",
         "Greatest number of scattering events; 0: unlimited",
         +[](Scene& s) -> int& { return s.bounces; },
         {Ends::inside, 0, most, "1 or more, or 0 for as many as it takes"}},
        {"seed", "--seed", "Sampling", "Seed of the random numbers", +[](Scene& s) -> std::uint64_t& { return s.seed; }, {}},
        {"feature_samples",
         "--feature-samples",
         "Sampling",
         "Rays per pixel of the noise-free features",
         +[](Scene& s) -> int& { return s.feature_samples; },
         {Ends::alone, 1, 4, "1 or 4"}},
        {"features", "features", "", nullptr, +[](Scene& s) -> bool& { return s.features; }, {}},
        {"view", "view", "", nullptr, +[](Scene& s) -> int& { return s.view; }, {Ends::inside, 0, most, "0 or more"}},
        {"exposure",
         "--exposure",
         "Output",
         "PNG and JPEG: exposure in stops",
         +[](Scene& s) -> double& { return s.exposure; },
         {Ends::inside, -64, 64}},
    };
    return all;
}

const SceneSetting& scene_setting(const std::string& key) {
    for (const SceneSetting& s : scene_settings())
        if (s.key == key) return s;
    throw std::logic_error("no setting of a scene: " + key);
}

const Names<Mode>& mode_names() {
    static const Names<Mode> names{{"path", Mode::path}, {"dvr", Mode::dvr}, {"mip", Mode::mip}};
    return names;
}

const Names<Shading>& shading_names() {
    static const Names<Shading> names{{"auto", Shading::automatic}, {"phase", Shading::phase}, {"gradient", Shading::gradient}};
    return names;
}

} // namespace clvr
