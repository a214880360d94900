// clvr denoise: a noisy frame to a clean one.
#include "host/cli/commands.hpp"
#include "host/cli/device_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/render/scene.hpp"
#include "runtime/dealer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <array>
#include <filesystem>

namespace clvr {

namespace {

struct Options {
    std::string input, model = "default";
    std::vector<std::string> outputs, show, map;
    int spp = 0; ///< 0: as the frame says
    Tonemap tonemap;
    DeviceOptions device;
};

/// Renames channels of other renderers' files: "albedo=DiffCol" takes DiffCol.R as albedo.R and so on, "depth.Z=Depth.V" one channel.
/// "beauty" is R G B A.
void map_channels(Frame& frame, const std::string& mapping, const std::string& file) {
    const std::size_t sign = mapping.find('=');
    if (sign == mapping.npos || sign == 0 || sign + 1 == mapping.size())
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected CLVR'S=THEIRS, for instance albedo=DiffCol", mapping), "--map");
    const std::string to = mapping.substr(0, sign), from = mapping.substr(sign + 1);
    if (frame.has(from)) {
        frame.channels[to] = frame.at(from);
        return;
    }
    const std::string axes = "XYZ", colours = "RGBA";
    int mapped = 0;
    for (const char suffix : std::string("RGBAXYZV")) {
        if (!frame.has(from + "." + suffix)) continue;
        char named = suffix;
        if (to == "normal" && colours.find(suffix) < axes.size()) named = axes[colours.find(suffix)];
        frame.channels[to == "beauty" ? std::string(1, named) : to + "." + named] = frame.at(from + "." + suffix);
        ++mapped;
    }
    if (mapped > 0) return;
    std::vector<std::string> has;
    for (const auto& [name, values] : frame.channels) has.push_back(name);
    throw Error(ErrorKind::input, fmt::format("has no channel {} or {}.* (--map {}); it has {}", from, from, mapping, fmt::join(has, " ")),
                file);
}

DenoiserView view_of(const std::vector<std::string>& names) {
    DenoiserView view;
    for (const auto& name : names) {
        if (name == "guides")
            view.guides = true;
        else if (name == "weights")
            view.weights = true;
        else if (name == "levels")
            view.levels = true;
        else
            throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected guides, weights or levels", name), "--show");
    }
    return view;
}

/// A picture of what the network made, beside the output: out.guide.1.png, out.level1.png.
struct Shown {
    std::string path;
    std::array<std::string, 3> channels; ///< shown as red, green, blue
    bool is_light = false;               ///< for the tone map
};

std::vector<Shown> shown_of(const Frame& frame, const std::string& output) {
    const auto path = [&](const std::string& name) {
        const std::filesystem::path p(output);
        return (p.parent_path() / (p.stem().string() + "." + name + ".png")).string();
    };
    std::vector<Shown> shown;
    for (const auto& [name, values] : frame.channels) {
        if (name.rfind("guide.", 0) == 0 || name.rfind("weight.", 0) == 0) {
            shown.push_back({path(name), {name, name, name}, false});
        } else if (name.rfind("level", 0) == 0 && name.size() > 2 && name.substr(name.size() - 2) == ".R") {
            const std::string level = name.substr(0, name.size() - 2);
            shown.push_back({path(level), {level + ".R", level + ".G", level + ".B"}, true});
        }
    }
    return shown;
}

void write_shown(const Frame& frame, const Shown& shown, const Tonemap& tonemap) {
    Frame picture;
    picture.width = frame.width, picture.height = frame.height;
    const char* const colours[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) picture.channels[colours[c]] = frame.at(shown.channels[c]);
    write_png(picture, shown.is_light ? tonemap : Tonemap{"none", 0}, shown.path);
}

void denoise(const Options& o) {
    if (o.outputs.empty()) throw Error(ErrorKind::usage, "no output given: add -o picture.png (or .exr for all channels)", "clvr denoise");
    if (o.spp < 0 || o.spp > largest_spp)
        throw Error(ErrorKind::usage, fmt::format("is {}; expected 1 to {}", o.spp, largest_spp), "--spp");
    const DenoiserView view = view_of(o.show);
    for (const auto& path : o.outputs) check_frame_path(path);
    const Model model = read_model(o.model);
    Frame frame = read_exr(o.input);
    if (o.spp > 0) frame.attributes["clvr.spp"] = std::to_string(o.spp);
    for (const auto& mapping : o.map) map_channels(frame, mapping, o.input);
    std::vector<Device> devices = open_devices(o.device);
    std::size_t repaired = 0;
    try {
        frame = on_first(devices, [&](Device& device) {
            Denoiser denoiser(device, model);
            Frame clean = denoiser.denoise(frame, view);
            repaired = denoiser.repaired();
            return clean;
        });
    } catch (const Error& e) {
        throw e.kind() == ErrorKind::input ? Error(e.kind(), e.what(), o.input) : e;
    }
    if (repaired > 0) spdlog::warn("{}: {} values are not finite; taken as 0", o.input, repaired);
    std::vector<Shown> shown;
    if (!o.show.empty()) shown = shown_of(frame, o.outputs.front());
    for (const Shown& picture : shown) will_write(picture.path, "--show"); // their names come from the model
    for (const auto& path : o.outputs) write_frame(frame, o.tonemap, path);
    for (const Shown& picture : shown) write_shown(frame, picture, o.tonemap);
    print_profiles(o.device, {devices.front()});
}

} // namespace

void add_denoise_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("denoise", "Denoise a rendered frame (EXR) with a trained network");
    auto o = std::make_shared<Options>();
    reads_files(c->add_option("IN", o->input, "Noisy frame (.exr) with the channels that the model names")->required());
    writes_files(c->add_option("-o,--output", o->outputs, "Picture to write: .png, or .exr with all channels (may be given twice)")
                     ->type_name("FILE"));
    reads_files(c->add_option("--model", o->model, "Trained network (.safetensors) [the one inside clvr]")->type_name("FILE"));
    c->add_option("--spp", o->spp, "Samples per pixel of a frame that does not say it (another renderer's)");
    c->add_option("--map", o->map,
                  "Take another renderer's channels: albedo=DiffCol, depth.Z=Depth.V, beauty=Combined (may be given again)")
        ->type_name("CLVR'S=THEIRS")
        ->delimiter(',');
    c->add_option("--show", o->show, "Also write what the network made, beside the output: guides, weights, levels")
        ->type_name("WHAT")
        ->delimiter(',');
    c->add_option("--exposure", o->tonemap.exposure, "PNG: exposure in stops [0]");
    c->add_option("--tonemap", o->tonemap.curve, "PNG: filmic, aces, reinhard or none [filmic]");
    add_device_options(*c, o->device, "denoise");
    c->callback([o] { denoise(*o); });
}

} // namespace clvr
