#include "host/render/scene.hpp"
#include "host/render/scene_settings.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <type_traits>

namespace clvr {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& found, const std::string& expected) {
    throw Error(ErrorKind::usage, fmt::format("is {}; expected {}", found, expected), option);
}

void check_settings(const Scene& scene) {
    for (const SceneSetting& setting : scene_settings())
        visit_setting(setting, scene, [&](const auto& value) {
            using T = std::decay_t<decltype(value)>;
            if constexpr (std::is_same_v<T, double> || std::is_same_v<T, int>)
                if (!setting.range.holds(value)) refuse(setting.name, fmt::format("{}", value), setting.range.text());
        });
}

void check_finite(const char* option, double value) {
    if (!std::isfinite(value)) refuse(option, fmt::format("{}", value), "a finite number");
}

void check_finite(const char* option, const Double3& v) {
    for (double x : v) check_finite(option, x);
}

void check_not_negative(const char* option, double value) {
    if (!(value >= 0) || !std::isfinite(value)) refuse(option, fmt::format("{}", value), "a finite number of 0 or more");
}

void check_camera(const Camera& camera) {
    check_finite("camera.up", camera.up);
    if (norm(camera.up) == 0) refuse("camera.up", "0 0 0", "a direction");
    if (camera.eye.has_value() != camera.target.has_value())
        refuse("--eye, --target", camera.eye ? "an eye without a target" : "a target without an eye", "both or neither");
    if (!camera.eye) return;
    check_finite("--eye", *camera.eye);
    check_finite("--target", *camera.target);
    const Double3 view = *camera.target - *camera.eye;
    if (norm(view) == 0) refuse("--target", "the place of the eye", "another place");
    if (norm(cross(view, camera.up)) <= 1e-6 * norm(view) * norm(camera.up))
        refuse("camera.up", "parallel to the view", "another direction");
    if (camera.orthographic && camera.height == 0) refuse("camera.height", "0", "the height of the orthographic view in mm");
}

void check_light(const Light& light) {
    if ((light.environment == Light::Environment::image) != !light.image.empty())
        refuse("light.image", light.image.empty() ? "empty" : fmt::format("'{}'", light.image),
               "a file where the environment is an image, and only there");
}

void check_clips(const Scene& scene) {
    if (scene.clip_box)
        for (int axis = 0; axis < 3; ++axis) {
            const double low = (*scene.clip_box)[axis], high = (*scene.clip_box)[axis + 3];
            if (!(low >= 0 && low < high && high <= 1))
                refuse("--clip-box", fmt::format("{} to {} along axis {}", low, high, "xyz"[axis]), "0 <= low < high <= 1");
        }
    if (scene.clip_plane) {
        check_finite("--clip-plane", scene.clip_plane->normal);
        check_finite("--clip-plane", scene.clip_plane->offset);
        if (norm(scene.clip_plane->normal) == 0) refuse("--clip-plane", "a plane with the normal 0 0 0", "a direction");
    }
}

} // namespace

void validate(const Scene& scene) {
    if (scene.volume.empty()) refuse("VOLUME", "empty", "a file, a folder or demo:head");
    if (scene.reading.frame < 0) refuse("--frame", fmt::format("{}", scene.reading.frame), "0 or more");
    if (scene.reading.channel.value_or(0) < 0) refuse("--channel", fmt::format("{}", *scene.reading.channel), "0 or more");
    check_settings(scene);
    check_camera(scene.camera);
    check_light(scene.light);
    for (double c : scene.background.color) check_not_negative("--background", c);
    check_clips(scene);
    if (std::find(tonemap_names.begin(), tonemap_names.end(), scene.tonemap) == tonemap_names.end())
        refuse("--tonemap", fmt::format("'{}'", scene.tonemap), fmt::format("one of {}", fmt::join(tonemap_names, ", ")));
    if (scene.transfer) validate(*scene.transfer, "--tf");
}

} // namespace clvr
