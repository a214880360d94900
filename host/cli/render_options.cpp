#include "host/cli/render_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/open_volume.hpp"
#include "host/cli/volume_options.hpp"
#include "host/io/atomic_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/volume/srgb.hpp"
#include "runtime/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace clvr {

namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& found, const std::string& expected) {
    throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected {}", found, expected), option);
}

std::optional<double> number(const std::string& text) {
    if (text.empty()) return {};
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (*end != 0) return {};
    return value;
}

/// "1,2,3" as so many numbers.
std::vector<double> numbers(const std::string& option, const std::string& text, std::size_t count, const std::string& expected) {
    std::vector<double> values;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const auto value = number(text.substr(begin, end - begin));
        if (!value) refuse(option, text, expected);
        values.push_back(*value);
        begin = end + 1;
    }
    if (values.size() != count) refuse(option, text, expected);
    return values;
}

Double3 point(const std::string& option, const std::string& text) {
    const auto v = numbers(option, text, 3, "X,Y,Z in mm");
    return {v[0], v[1], v[2]};
}

template <class T>
T choice(const std::string& option, const std::string& text, const std::map<std::string, T>& values) {
    const auto found = values.find(text);
    if (found != values.end()) return found->second;
    std::string names;
    for (const auto& [name, value] : values) names += (names.empty() ? "" : ", ") + name;
    refuse(option, text, "one of " + names);
}

void set_size(Scene& scene, const std::string& text) {
    int w = 0, h = 0;
    const char *begin = text.data(), *end = begin + text.size();
    auto [x, failed] = std::from_chars(begin, end, w);
    if (failed != std::errc{} || x == end || *x != 'x') refuse("--size", text, "WIDTHxHEIGHT, for instance 1280x720");
    auto [rest, failed_too] = std::from_chars(x + 1, end, h);
    if (failed_too != std::errc{} || rest != end) refuse("--size", text, "WIDTHxHEIGHT, for instance 1280x720");
    scene.width = w, scene.height = h;
}

/// sky, a radiance, or an image file. The key light belongs to the sky: another environment is the only light unless --key asks for more.
void set_environment(Scene& scene, const std::string& text) {
    Light& light = scene.light;
    if (text == "sky") {
        light.environment = Light::Environment::sky;
        light.key = Light{}.key;
        return;
    }
    light.key = 0;
    if (const auto level = number(text)) {
        light.environment = Light::Environment::constant;
        light.level = *level;
    } else {
        light.environment = Light::Environment::image;
        light.image = text;
        light.level = 1;
    }
}

void set_background(Scene& scene, const std::string& text) {
    const std::string expected = "transparent, environment or a colour as #rrggbb";
    if (text == "transparent")
        scene.background.kind = Background::Kind::transparent;
    else if (text == "environment")
        scene.background.kind = Background::Kind::environment;
    else {
        if (text.size() != 7 || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
            refuse("--background", text, expected);
        scene.background.kind = Background::Kind::color;
        for (int k = 0; k < 3; ++k) scene.background.color[k] = srgb_decode(std::stoi(text.substr(1 + 2 * k, 2), nullptr, 16) / 255.0);
    }
}

TransferFunction transfer_of(const std::string& name) {
    const auto presets = transfer_presets();
    if (std::any_of(presets.begin(), presets.end(), [&](const Preset& p) { return p.name == name; })) return transfer_preset(name);
    std::error_code failed;
    if (std::filesystem::is_regular_file(name, failed)) return parse_transfer_function(read_text(name), name);
    return transfer_preset(name); // throws with the list of names
}

} // namespace

std::string view_path(const std::string& path, int view) {
    const std::filesystem::path p(path);
    return (p.parent_path() / fmt::format("{}_{:03}{}", p.stem().string(), view, p.extension().string())).string();
}

std::vector<std::string> view_paths(const std::string& path, int views) {
    if (views <= 0 || views > largest_turntable) return {path};
    std::vector<std::string> paths;
    for (int view = 0; view < views; ++view) paths.push_back(view_path(path, view));
    return paths;
}

void add_scene_options(CLI::App& c, RenderOptions& o) {
    reads_files(c.add_option("VOLUME", o.input, "Volume file or folder, scene JSON, or demo:head"));
    c.add_option("--spp", o.spp, "Samples per pixel [64]")->group("Picture");
    c.add_option("--size", o.size, "Picture size [640x640]")->type_name("WxH")->group("Picture");
    c.add_option("--seed", o.seed, "Seed of the random numbers [0]")->group("Picture");
    c.add_option("--mode", o.mode, "path (path tracing), dvr (emission-absorption) or mip (maximum) [path]")->group("Picture");
    c.add_option("--background", o.background, "transparent, environment or #rrggbb [transparent]")->group("Picture");
    c.add_option("--feature-samples", o.feature_samples, "Rays per pixel of the noise-free features, 1 or 4 [4]")->group("Picture");

    reads_files(c.add_option("--tf", o.transfer,
                             "Transfer function: a preset's name, a JSON file (clvr's or ParaView's), or auto: from the histogram [auto]")
                    ->type_name("NAME|FILE")
                    ->group("Volume"));
    c.add_option("--extinction", o.extinction, "Extinction at opacity 1 [1/mm] [512 / diagonal]")->group("Volume");
    c.add_option("--clip-box", o.clip_box, "Keep only this part, as shares 0..1 of the volume along its axes")
        ->type_name("I0,J0,K0,I1,J1,K1")
        ->group("Volume");
    c.add_option("--clip-plane", o.clip_plane,
                 "Cut away what lies beyond the plane: normal in world space, offset in mm from the world's origin")
        ->type_name("NX,NY,NZ,OFFSET")
        ->group("Volume");

    c.add_option("--shading", o.shading, "auto, phase or gradient [auto]")->group("Light");
    c.add_option("--phase-g", o.phase_g, "Henyey-Greenstein asymmetry, -1 < g < 1 [0]")->group("Light");
    c.add_option("--bounces", o.bounces, "Greatest number of scattering events, 0: unlimited [8]")->group("Light");
    reads_files(c.add_option("--environment", o.environment, "sky, a constant radiance, or an image (.hdr, .exr) [sky]")
                    ->type_name("sky|L|FILE")
                    ->group("Light"));
    c.add_option("--environment-rotation", o.environment_rotation, "Turns the image around the vertical axis [degrees]")->group("Light");
    c.add_option("--key", o.key, "Strength of the soft key light [1 under the sky, else 0]")->group("Light");
    c.add_option("--key-azimuth", o.key_azimuth, "Direction of the key light, relative to the camera's [-40 degrees]")->group("Light");
    c.add_option("--key-elevation", o.key_elevation, "Height of the key light [45 degrees]")->group("Light");
    c.add_option("--headlight", o.headlight, "Irradiance of a light from the camera [0]")->group("Light");

    c.add_option("--azimuth", o.azimuth, "Camera: degrees around the vertical axis; 0 faces a patient, 90 sees the left side [30]")
        ->group("Camera");
    c.add_option("--elevation", o.elevation, "Camera: degrees above the horizon [12]")->group("Camera");
    c.add_option("--zoom", o.zoom, "Camera: above 1 enlarges [1]")->group("Camera");
    c.add_option("--fov", o.fov, "Camera: vertical field of view [30 degrees]")->group("Camera");
    c.add_option("--eye", o.eye, "Camera: position in world space [mm], with --target")->type_name("X,Y,Z")->group("Camera");
    c.add_option("--target", o.target, "Camera: what it looks at [mm]")->type_name("X,Y,Z")->group("Camera");
    c.add_flag("--orthographic", o.orthographic, "Camera: parallel projection")->group("Camera");

    add_volume_options(c, o.volume);
    add_device_options(c, o.devices, "render");
}

void add_render_options(CLI::App& c, RenderOptions& o) {
    writes_files(
        c.add_option("-o,--output", o.outputs, "Picture to write: .png, or .exr with all channels (may be given twice)")->type_name("FILE"),
        [&o](const std::string& path) { return view_paths(path, o.turntable); });
    c.add_option("--time", o.seconds, "Stop after about so many seconds, with whole passes of samples")
        ->type_name("SECONDS")
        ->group("Picture");
    c.add_option("--turntable", o.turntable, "Write a numbered sequence of N views around the volume")->type_name("N")->group("Picture");
    c.add_option("--exposure", o.exposure, "PNG: exposure in stops [0]")->group("Picture");
    c.add_option("--tonemap", o.tonemap, "PNG: filmic, aces, reinhard or none [filmic]")->group("Picture");
    c.add_flag("--no-features", o.no_features, "EXR: leave the noise-free features out")->group("Picture");
    c.add_flag("--denoise", o.denoise, "Denoise with a trained network; an EXR keeps the noisy picture as noisy.*")->group("Picture");
    reads_files(c.add_option("--model", o.model, "The network of --denoise (.safetensors) [the one inside clvr]")
                    ->type_name("FILE")
                    ->group("Picture"));
    c.add_flag("--list-tf", o.list_transfer, "List the presets")->group("Volume");
    writes_files(
        c.add_option("--save-scene", o.save_scene, "Write a scene JSON that gives this picture again")->type_name("FILE")->group("Device"));
    add_scene_options(c, o);
}

Scene scene_of(const RenderOptions& o) {
    Scene s;
    if (!is_demo_volume(o.input) && is_scene_file(o.input))
        s = parse_scene(read_text(o.input), o.input);
    else
        s.volume = o.input;
    override_reading(s.reading, o.volume);

    const auto set = [](auto& field, const auto& option) {
        if (option) field = *option;
    };
    set(s.spp, o.spp), set(s.seed, o.seed), set(s.bounces, o.bounces), set(s.feature_samples, o.feature_samples);
    if (o.seconds > 0 && !o.spp) s.spp = 1 << 20;
    set(s.exposure, o.exposure), set(s.tonemap, o.tonemap), set(s.phase_g, o.phase_g), set(s.extinction, o.extinction);
    set(s.camera.azimuth, o.azimuth), set(s.camera.elevation, o.elevation), set(s.camera.zoom, o.zoom), set(s.camera.fov, o.fov);
    if (o.orthographic) s.camera.orthographic = true;
    if (o.eye) s.camera.eye = point("--eye", *o.eye);
    if (o.target) s.camera.target = point("--target", *o.target);
    if (o.size) set_size(s, *o.size);
    if (o.mode) s.mode = choice<Mode>("--mode", *o.mode, {{"path", Mode::path}, {"dvr", Mode::dvr}, {"mip", Mode::mip}});
    if (o.shading)
        s.shading = choice<Shading>("--shading", *o.shading,
                                    {{"auto", Shading::automatic}, {"phase", Shading::phase}, {"gradient", Shading::gradient}});
    if (o.transfer == "auto")
        s.transfer.reset();
    else if (o.transfer)
        s.transfer = transfer_of(*o.transfer);
    if (o.environment) set_environment(s, *o.environment);
    if (o.background) set_background(s, *o.background);
    set(s.light.image_rotation, o.environment_rotation), set(s.light.key, o.key), set(s.light.key_azimuth, o.key_azimuth);
    set(s.light.key_elevation, o.key_elevation), set(s.light.headlight, o.headlight);
    if (o.clip_box) {
        const auto v = numbers("--clip-box", *o.clip_box, 6, "I0,J0,K0,I1,J1,K1 as shares from 0 to 1");
        s.clip_box.emplace();
        std::copy(v.begin(), v.end(), s.clip_box->begin());
    }
    if (o.clip_plane) {
        const auto v = numbers("--clip-plane", *o.clip_plane, 4, "NX,NY,NZ,OFFSET");
        s.clip_plane = ClipPlane{{v[0], v[1], v[2]}, v[3]};
    }
    if (o.no_features) s.features = false;
    validate(s);
    return s;
}

} // namespace clvr
