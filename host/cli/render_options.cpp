#include "host/cli/render_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/open_volume.hpp"
#include "host/cli/volume_options.hpp"
#include "host/frame/srgb.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/render/scene_settings.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <type_traits>

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
T choice(const std::string& option, const std::string& text, const Names<T>& values) {
    std::string names;
    for (const auto& [name, value] : values) {
        if (text == name) return value;
        names += (names.empty() ? "" : ", ") + std::string(name);
    }
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

void add_setting(CLI::App& c, RenderOptions& o, const std::string& key, const std::string& help) {
    const SceneSetting& setting = scene_setting(key);
    std::string text = help.empty() ? setting.help : help;
    visit_setting(setting, Scene(), [&](const auto& usual) {
        using T = std::decay_t<decltype(usual)>;
        if (text.back() != ']') text += fmt::format(" [{}]", usual);
        c.add_option_function<T>(
             setting.name, [&o, key](const T& value) { o.settings[key] = value; }, text)
            ->group(setting.group);
    });
}

void add_scene_options(CLI::App& c, RenderOptions& o) {
    const auto add_settings = [&](const std::string& group) {
        for (const SceneSetting& s : scene_settings())
            if (s.help && s.group == group) add_setting(c, o, s.key);
    };
    c.add_option("VOLUME", o.input, "Volume file or folder, scene JSON, or demo:head and the like")->type_name("FILE|DIR|DEMO");
    c.add_option("--size", o.size, "Picture size [640x640]")->type_name("WxH")->group("Output");
    add_setting(c, o, "spp");
    c.add_option("--background", o.background, "What is seen past the volume [transparent]")
        ->type_name("transparent|environment|#rrggbb")
        ->group("Output");

    c.add_option(
         "--tf", o.transfer,
         "Transfer function, what each value looks like: a preset, a JSON file (clvr's, see below, or ParaView's), or auto: from the "
         "histogram [auto]")
        ->type_name("auto|PRESET|FILE")
        ->group("Look");
    c.add_option("--mode", o.mode, "Path tracing, emission and absorption, or maximum intensity [path]")
        ->type_name("path|dvr|mip")
        ->group("Look");
    c.add_option("--shading", o.shading, "Like fog (phase), like surfaces (gradient), or by the local gradient (auto) [auto]")
        ->type_name("auto|phase|gradient")
        ->group("Look");
    add_settings("Look");
    c.add_option("--clip-box", o.clip_box, "Keep only this part, as shares 0..1 of the volume along its axes")
        ->type_name("I0,J0,K0,I1,J1,K1")
        ->group("Look");
    c.add_option("--clip-plane", o.clip_plane,
                 "Cut away what lies beyond the plane: its normal, and its offset from the origin in mm, both in LPS")
        ->type_name("NX,NY,NZ,OFFSET")
        ->group("Look");

    add_settings("Camera");
    c.add_flag("--orthographic", o.orthographic, "Parallel projection")->group("Camera");
    c.add_option("--eye", o.eye, "Position of the camera in LPS millimetres (to the patient's left, back, head), with --target")
        ->type_name("X,Y,Z")
        ->group("Camera");
    c.add_option("--target", o.target, "What the camera looks at, in LPS millimetres")->type_name("X,Y,Z")->group("Camera");

    c.add_option("--environment", o.environment, "The sky, a constant radiance such as 1, or an image (.hdr, .exr, .pfm) [sky]")
        ->type_name("sky|L|FILE")
        ->group("Light");
    add_settings("Light");

    add_settings("Sampling");
    c.get_option("--feature-samples")->type_name("1|4");

    reads_files(c, {"VOLUME", "--tf", "--environment"});
    add_volume_options(c, o.volume);
    add_device_options(c, o.devices, "render");
}

void add_render_options(CLI::App& c, RenderOptions& o) {
    c.add_option("-o,--output", o.outputs, "Picture to write: .png, .jpg, or .exr with all channels (may be given twice)")
        ->type_name("FILE")
        ->group("Output");
    c.add_flag("--beside", o.beside, "Without -o, write a PNG beside the volume, unless there is one")->group("");
    add_scene_options(c, o);
    c.add_flag("--denoise", o.denoise, "Denoise with a trained network; an EXR keeps the noisy picture as noisy.*")->group("Output");
    c.add_option("--model", o.model, "The network of --denoise (.safetensors) [the one inside clvr]")->type_name("FILE")->group("Output");
    c.add_option("--time", o.seconds, "Stop after about so many seconds, with whole passes of samples")
        ->type_name("SECONDS")
        ->group("Output");
    c.add_option("--turntable", o.turntable, "Write a numbered sequence of N views around the volume")->type_name("N")->group("Output");
    add_setting(c, o, "exposure");
    c.add_option("--tonemap", o.tonemap, "PNG and JPEG: tone curve [filmic]")->type_name("filmic|aces|reinhard|none")->group("Output");
    add_channels_option(c, o.channels);
    c.add_flag("--no-features", o.no_features, "EXR: leave the noise-free features out")->group("Output");
    c.add_option("--save-scene", o.save_scene, "Write a scene JSON that gives this picture again")->type_name("FILE")->group("Output");
    c.add_flag("--list-tf", o.list_transfer, "List the presets of --tf")->group("Look");
    reads_files(c, {"--model"});
    writes_files(c, "--output", [&o](const std::string& path) { return view_paths(path, o.turntable); });
    writes_files(c, "--save-scene");
}

Scene scene_of(const RenderOptions& o) {
    Scene s;
    if (!is_demo_volume(o.input) && is_scene_file(o.input))
        s = parse_scene(read_text(o.input), o.input);
    else
        s.volume = o.input;
    override_reading(s.reading, o.volume);

    const auto apply = [&](const std::string& key, const auto& value) {
        visit_setting(scene_setting(key), s, [&](auto& field) { field = std::get<std::decay_t<decltype(field)>>(value); });
    };
    if (o.seconds > 0 && o.settings.count("spp") == 0) s.spp = largest_spp;
    if (o.tonemap) s.tonemap = *o.tonemap;
    if (o.orthographic) s.camera.orthographic = true;
    if (o.eye) s.camera.eye = point("--eye", *o.eye);
    if (o.target) s.camera.target = point("--target", *o.target);
    if (o.size) set_size(s, *o.size);
    if (o.mode) s.mode = choice("--mode", *o.mode, mode_names());
    if (o.shading) s.shading = choice("--shading", *o.shading, shading_names());
    if (o.transfer == "auto")
        s.transfer.reset();
    else if (o.transfer)
        s.transfer = transfer_of(*o.transfer);
    if (o.environment) set_environment(s, *o.environment);
    if (o.background) set_background(s, *o.background);
    for (const auto& [key, value] : o.settings) apply(key, value); // after the environment, which has a key light of its own
    if (o.clip_box) {
        const auto v = numbers("--clip-box", *o.clip_box, 6, "I0,J0,K0,I1,J1,K1 as shares from 0 to 1");
        s.clip_box.emplace();
        std::copy(v.begin(), v.end(), s.clip_box->begin());
    }
    if (o.clip_plane) {
        const auto v = numbers("--clip-plane", *o.clip_plane, 4, "NX,NY,NZ,OFFSET");
        s.clip_plane = ClipPlane{{v[0], v[1], v[2]}, v[3]};
    }
    if (o.no_features || o.channels.beauty()) s.features = false;
    validate(s);
    return s;
}

} // namespace clvr
