#include "host/io/scene/scene_file.hpp"
#include "host/appearance/transfer_function_json.hpp"
#include "host/io/volume/dataset_path.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_fields.hpp"
#include "runtime/system/json_text.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace clvr {
namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr const char* scene_tag = "scene/1";

template <class E>
using Names = std::vector<std::pair<const char*, E>>;
const Names<Mode> modes{{"path", Mode::path}, {"dvr", Mode::dvr}, {"mip", Mode::mip}};
const Names<Shading> shadings{{"auto", Shading::automatic}, {"phase", Shading::phase}, {"gradient", Shading::gradient}};
const Names<Light::Environment> environments{
    {"constant", Light::Environment::constant}, {"sky", Light::Environment::sky}, {"image", Light::Environment::image}};
const Names<Background::Kind> backgrounds{
    {"transparent", Background::Kind::transparent}, {"environment", Background::Kind::environment}, {"color", Background::Kind::color}};

template <class E>
const char* name_of(const Names<E>& names, E value) {
    return std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == value; })->first;
}

/// An optional list of numbers: absent stays absent.
template <class T>
void get_optional(JsonFields& fields, const std::string& name, std::optional<T>& value) {
    if (fields.has(name)) fields.get(name, value.emplace());
}

/// Writes the member only where there is a value.
template <class T>
void put_optional(ordered_json& to, const char* name, const std::optional<T>& value) {
    if (value) to[name] = *value;
}

ordered_json raw_json(const VolumeReadOptions& raw) {
    ordered_json to = ordered_json::object();
    put_optional(to, "dims", raw.dims);
    to["type"] = raw.type;
    put_optional(to, "spacing", raw.spacing);
    to["endian"] = raw.endian;
    return to;
}

void parse_raw(JsonFields fields, VolumeReadOptions& raw) {
    get_optional(fields, "dims", raw.dims);
    fields.get("type", raw.type);
    get_optional(fields, "spacing", raw.spacing);
    fields.get("endian", raw.endian);
    fields.done();
}

ordered_json camera_json(const Camera& camera) {
    ordered_json to{{"orthographic", camera.orthographic},
                    {"fov", camera.fov},
                    {"azimuth", camera.azimuth},
                    {"elevation", camera.elevation},
                    {"zoom", camera.zoom}};
    put_optional(to, "eye", camera.eye);
    put_optional(to, "target", camera.target);
    to["up"] = camera.up;
    to["height"] = camera.height;
    return to;
}

Camera parse_camera(JsonFields fields) {
    Camera camera;
    fields.get("orthographic", camera.orthographic);
    fields.get("fov", camera.fov);
    fields.get("azimuth", camera.azimuth);
    fields.get("elevation", camera.elevation);
    fields.get("zoom", camera.zoom);
    get_optional(fields, "eye", camera.eye);
    get_optional(fields, "target", camera.target);
    fields.get("up", camera.up);
    fields.get("height", camera.height);
    fields.done();
    return camera;
}

ordered_json light_json(const Light& light) {
    return {{"environment", name_of(environments, light.environment)},
            {"level", light.level},
            {"image", light.image},
            {"image_rotation", light.image_rotation},
            {"key", light.key},
            {"key_azimuth", light.key_azimuth},
            {"key_elevation", light.key_elevation},
            {"key_angle", light.key_angle},
            {"headlight", light.headlight}};
}

Light parse_light(JsonFields fields) {
    Light light;
    fields.choose("environment", light.environment, environments);
    fields.get("level", light.level);
    fields.get("image", light.image);
    fields.get("image_rotation", light.image_rotation);
    fields.get("key", light.key);
    fields.get("key_azimuth", light.key_azimuth);
    fields.get("key_elevation", light.key_elevation);
    fields.get("key_angle", light.key_angle);
    fields.get("headlight", light.headlight);
    fields.done();
    return light;
}

Background parse_background(JsonFields fields) {
    Background background;
    fields.choose("kind", background.kind, backgrounds);
    fields.get("color", background.color);
    fields.done();
    return background;
}

ClipPlane parse_clip_plane(JsonFields fields) {
    ClipPlane plane;
    fields.get("normal", plane.normal);
    fields.get("offset", plane.offset);
    fields.done();
    return plane;
}

bool is_built_in(const std::string& volume) { return volume.rfind("demo:", 0) == 0; }

/// Calls change(path) on every path of the scene that names a file: of FILE:/path/of/dataset on FILE.
template <class F>
void for_each_path(Scene& scene, F&& change) {
    if (!scene.volume.empty() && !is_built_in(scene.volume)) {
        DatasetPath volume = split_dataset_path(scene.volume);
        change(volume.file);
        scene.volume = join_dataset_path(volume);
    }
    if (!scene.light.image.empty()) change(scene.light.image);
}

} // namespace

std::string to_json(const Scene& scene) {
    ordered_json to{{format_key, scene_tag},         {"volume", scene.volume},         {"volume_sha256", scene.volume_sha256},
                    {"frame", scene.reading.frame},  {"series", scene.reading.series}, {"allow_gaps", scene.reading.allow_gaps},
                    {"raw", raw_json(scene.reading)}};
    put_optional(to, "channel", scene.reading.channel);
    if (!scene.reading.array.empty()) to["array"] = scene.reading.array;
    if (scene.reading.recursive) to["recursive"] = true;
    if (scene.transfer) to["transfer"] = ordered_json::parse(to_json(*scene.transfer));
    to["mode"] = name_of(modes, scene.mode);
    to["shading"] = name_of(shadings, scene.shading);
    to["phase_g"] = scene.phase_g;
    to["extinction"] = scene.extinction;
    to["bounces"] = scene.bounces;
    to["width"] = scene.width;
    to["height"] = scene.height;
    to["spp"] = scene.spp;
    to["feature_samples"] = scene.feature_samples;
    to["features"] = scene.features;
    to["seed"] = scene.seed;
    to["view"] = scene.view;
    to["camera"] = camera_json(scene.camera);
    to["light"] = light_json(scene.light);
    to["background"] = {{"kind", name_of(backgrounds, scene.background.kind)}, {"color", scene.background.color}};
    put_optional(to, "clip_box", scene.clip_box);
    if (scene.clip_plane) to["clip_plane"] = {{"normal", scene.clip_plane->normal}, {"offset", scene.clip_plane->offset}};
    to["exposure"] = scene.exposure;
    to["tonemap"] = scene.tonemap;
    return to.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Scene parse_scene(const std::string& json_text, const std::string& where) {
    const json file = parse_json(json_text, where);
    JsonFields fields(file, where);
    std::string format;
    fields.required(format_key);
    fields.get(format_key, format);
    if (format != scene_tag) fields.fail(format_key, scene_tag);

    Scene scene;
    fields.required("volume");
    fields.get("volume", scene.volume);
    fields.get("volume_sha256", scene.volume_sha256);
    fields.get("frame", scene.reading.frame);
    fields.get("series", scene.reading.series);
    fields.get("allow_gaps", scene.reading.allow_gaps);
    if (fields.has("channel")) fields.get("channel", scene.reading.channel.emplace());
    fields.get("array", scene.reading.array);
    fields.get("recursive", scene.reading.recursive);
    if (fields.has("raw")) parse_raw(fields.object("raw"), scene.reading);
    if (fields.has("transfer")) scene.transfer = parse_transfer_function(fields.required("transfer"), where);
    fields.choose("mode", scene.mode, modes);
    fields.choose("shading", scene.shading, shadings);
    fields.get("phase_g", scene.phase_g);
    fields.get("extinction", scene.extinction);
    fields.get("bounces", scene.bounces);
    fields.get("width", scene.width);
    fields.get("height", scene.height);
    fields.get("spp", scene.spp);
    fields.get("feature_samples", scene.feature_samples);
    fields.get("features", scene.features);
    fields.get("seed", scene.seed);
    fields.get("view", scene.view);
    if (fields.has("camera")) scene.camera = parse_camera(fields.object("camera"));
    if (fields.has("light")) scene.light = parse_light(fields.object("light"));
    if (fields.has("background")) scene.background = parse_background(fields.object("background"));
    get_optional(fields, "clip_box", scene.clip_box);
    if (fields.has("clip_plane")) scene.clip_plane = parse_clip_plane(fields.object("clip_plane"));
    fields.get("exposure", scene.exposure);
    fields.get("tonemap", scene.tonemap);
    fields.done();
    try {
        validate(scene);
    } catch (const Error& e) {
        throw Error(ErrorKind::input, e.line(), where);
    }
    for_each_path(scene, [&](std::string& path) { path = (fs::path(where).parent_path() / path).lexically_normal().string(); });
    return scene;
}

Scene read_scene(const std::string& path) { return parse_scene(read_text(path, std::size_t{16} << 20), path); }

void write_scene(const Scene& scene, const std::string& path) {
    Scene written = scene;
    const fs::path folder = fs::weakly_canonical(fs::absolute(path)).parent_path();
    for_each_path(written,
                  [&](std::string& named) { named = fs::weakly_canonical(fs::absolute(named)).lexically_relative(folder).string(); });
    const std::string text = to_json(written);
    write_atomically(path, text);
}

std::string provenance_json(const Scene& scene) {
    Scene named = scene;
    for_each_path(named, [](std::string& path) {
        const fs::path p = fs::path(path).lexically_normal();
        path = (p.has_filename() ? p : p.parent_path()).filename().string();
    });
    return to_json(named);
}

bool is_scene_file(const std::string& path) {
    std::error_code failed;
    if (!fs::is_regular_file(path, failed)) return false;
    std::ifstream in(path, std::ios::binary);
    std::string start(4096, '\0');
    in.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(in.gcount()));
    const std::size_t first = start.find_first_not_of("\xef\xbb\xbf \t\r\n");
    return first != start.npos && start[first] == '{' && start.find("\"clvr.format\"") != start.npos;
}

} // namespace clvr
