#include "host/render/scene.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clvr {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& found, const std::string& expected) {
    throw Error(ErrorKind::usage, fmt::format("is {}; expected {}", found, expected), option);
}

/// `value` in low..high, both ends allowed.
template <class T>
void check_range(const char* option, T value, T low, T high) {
    if (!(value >= low && value <= high)) refuse(option, fmt::format("{}", value), fmt::format("{} to {}", low, high));
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
    if (!(camera.fov > 0 && camera.fov < 180)) refuse("--fov", fmt::format("{}", camera.fov), "more than 0 and less than 180 degrees");
    if (!(camera.zoom > 0) || !std::isfinite(camera.zoom)) refuse("--zoom", fmt::format("{}", camera.zoom), "a finite number above 0");
    check_finite("--azimuth", camera.azimuth);
    check_range("--elevation", camera.elevation, -90.0, 90.0);
    check_not_negative("camera.height", camera.height);
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
    check_not_negative("--environment", light.level);
    if ((light.environment == Light::Environment::image) != !light.image.empty())
        refuse("light.image", light.image.empty() ? "empty" : fmt::format("'{}'", light.image),
               "a file where the environment is an image, and only there");
    check_finite("--environment-rotation", light.image_rotation);
    check_not_negative("--key", light.key);
    check_finite("--key-azimuth", light.key_azimuth);
    check_range("--key-elevation", light.key_elevation, -90.0, 90.0);
    check_range("light.key_angle", light.key_angle, 0.0, 180.0);
    check_not_negative("--headlight", light.headlight);
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
    check_range("--size (width)", scene.width, 1, largest_frame_side);
    check_range("--size (height)", scene.height, 1, largest_frame_side);
    check_range("--spp", scene.spp, 1, largest_spp);
    if (scene.feature_samples != 1 && scene.feature_samples != 4)
        refuse("--feature-samples", fmt::format("{}", scene.feature_samples), "1 or 4");
    if (scene.bounces < 0) refuse("--bounces", fmt::format("{}", scene.bounces), "1 or more, or 0 for as many as it takes");
    if (!(scene.phase_g > -1 && scene.phase_g < 1)) refuse("--phase-g", fmt::format("{}", scene.phase_g), "more than -1 and less than 1");
    check_not_negative("--extinction", scene.extinction);
    if (scene.view < 0) refuse("view", fmt::format("{}", scene.view), "0 or more");
    check_camera(scene.camera);
    check_light(scene.light);
    for (double c : scene.background.color) check_not_negative("--background", c);
    check_clips(scene);
    check_range("--exposure", scene.exposure, -64.0, 64.0);
    if (std::find(tonemap_names.begin(), tonemap_names.end(), scene.tonemap) == tonemap_names.end())
        refuse("--tonemap", fmt::format("'{}'", scene.tonemap), fmt::format("one of {}", fmt::join(tonemap_names, ", ")));
    if (scene.transfer) validate(*scene.transfer, "--tf");
}

} // namespace clvr
