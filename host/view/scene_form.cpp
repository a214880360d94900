#include "host/view/scene_form.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/view/limits.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_fields.hpp"
#include "runtime/system/json_text.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace clvr::view {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* first_handle = "scene";
constexpr const char* of_the_volume[] = {"volume", "volume_sha256", "frame", "series",   "allow_gaps",
                                         "raw",    "channel",       "array", "recursive"};

std::string file_name(const std::string& path) { return fs::path(path).filename().string(); }

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorKind::input, what, "scene"); }

} // namespace

Scene within_limits(Scene scene, std::vector<std::string>& notes) {
    if (const int side = std::max(scene.width, scene.height); side > largest_side) {
        const double shrink = static_cast<double>(largest_side) / side;
        for (int* const length : {&scene.width, &scene.height}) *length = std::max(1, static_cast<int>(*length * shrink));
        notes.push_back(fmt::format("The scene's picture is larger than {0} pixels a side; it is shown with {0}.", largest_side));
    }
    if (scene.spp > largest_samples)
        notes.push_back(fmt::format("The scene has more than {0} samples per pixel; it is shown with {0}.", largest_samples));
    scene.spp = std::min(scene.spp, largest_samples);
    return scene;
}

SceneForm::SceneForm(const Scene& first) : volume_(first) {
    if (!first.light.image.empty()) images_.push_back({first_handle, first.light.image, file_name(first.light.image)});
}

/// With the server's volume, within its limits.
Scene SceneForm::checked(Scene scene) const {
    scene.volume = volume_.volume, scene.volume_sha256 = volume_.volume_sha256, scene.reading = volume_.reading;
    if (scene.width > largest_side || scene.height > largest_side)
        refuse(fmt::format("is {} x {} pixels; expected at most {} a side", scene.width, scene.height, largest_side));
    if (scene.spp > largest_samples) refuse(fmt::format("has {} samples per pixel; expected at most {}", scene.spp, largest_samples));
    return scene;
}

Scene SceneForm::from_page(const std::string& text) const {
    json scene = parse_json(text, "scene");
    if (!scene.is_object()) refuse("is no object");
    for (const char* name : of_the_volume)
        if (scene.contains(name)) refuse(fmt::format("has the member {}, which is the server's", name));
    if (!scene.contains(format_key)) scene[format_key] = "scene/1";
    scene["volume"] = "demo:"; // any name that is no file's
    Scene parsed = parse_scene(scene.dump(-1, ' ', false, json::error_handler_t::replace), "scene");
    if (!parsed.light.image.empty()) {
        const auto image = std::find_if(images_.begin(), images_.end(), [&](const Image& i) { return i.handle == parsed.light.image; });
        if (image == images_.end()) refuse("light.image is no image that was uploaded");
        parsed.light.image = image->path;
    }
    return checked(std::move(parsed));
}

Scene SceneForm::from_file(const std::string& text, std::vector<std::string>& notes) const {
    Scene parsed = parse_scene(text, "scene");
    if (!parsed.light.image.empty()) {
        const std::string wanted = file_name(parsed.light.image);
        const auto image = std::find_if(images_.rbegin(), images_.rend(), [&](const Image& i) { return i.name == wanted; });
        if (image == images_.rend()) refuse("is lit by the image " + wanted + ": upload that first");
        parsed.light.image = image->path;
    }
    if (!parsed.volume_sha256.empty() && !volume_.volume_sha256.empty() && parsed.volume_sha256 != volume_.volume_sha256)
        notes.push_back("The scene was saved with another volume.");
    parsed = within_limits(std::move(parsed), notes);
    return checked(std::move(parsed));
}

std::string SceneForm::to_page(const Scene& scene) const {
    Scene shown = scene;
    for (const Image& image : images_)
        if (image.path == scene.light.image) shown.light.image = image.handle;
    auto to = nlohmann::ordered_json::parse(to_json(shown));
    for (const char* name : of_the_volume) to.erase(name);
    return to.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string SceneForm::to_file(const Scene& scene) const {
    Scene to = scene;
    to.light.image = image_name(scene);
    return provenance_json(to);
}

std::string SceneForm::image_name(const Scene& scene) const {
    for (const Image& image : images_)
        if (image.path == scene.light.image) return image.name;
    return scene.light.image;
}

std::string SceneForm::add_image(const std::string& path, const std::string& name) {
    images_.push_back({fmt::format("upload-{}", ++uploads_), path, name});
    return images_.back().handle;
}

std::vector<std::string> SceneForm::drop_images(std::size_t most, const Scene& kept) {
    std::vector<std::string> dropped;
    const auto is_upload = [](const Image& i) { return i.handle != first_handle; };
    auto surplus = std::count_if(images_.begin(), images_.end(), is_upload) - static_cast<std::ptrdiff_t>(most);
    for (auto image = images_.begin(); surplus > 0 && image != images_.end();) {
        const bool drop = is_upload(*image) && image->path != kept.light.image;
        if (drop) dropped.push_back(image->path), --surplus;
        image = drop ? images_.erase(image) : image + 1;
    }
    return dropped;
}

} // namespace clvr::view
