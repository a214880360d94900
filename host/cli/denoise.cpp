// clvr denoise: a noisy picture to a clean one.
#include "host/cli/commands.hpp"
#include "host/cli/device_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/picture_outputs.hpp"
#include "host/denoise/channels.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/denoise/model_choice.hpp"
#include "host/frame/channel_mapping.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/render/scene.hpp"
#include "runtime/schedule/scheduler.hpp"

#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <filesystem>
#include <optional>

namespace clvr {

namespace {

struct DenoiseOptions {
    std::string input, model, albedo, normal; // model empty: by what the frame has
    std::vector<std::string> outputs, show, map;
    int spp = 0; ///< 0: as the frame says
    std::optional<std::string> tonemap;
    double exposure = 0;
    ExrChannels channels;
    DeviceOptions device;
};

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
        const std::string ending = is_exr_path(output) ? ".png" : p.extension().string();
        return (p.parent_path() / (p.stem().string() + "." + name + ending)).string();
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
    Frame picture = frame.blank();
    const char* const colours[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) picture.channels[colours[c]] = frame.at(shown.channels[c]);
    write_frame(picture, shown.is_light ? tonemap : Tonemap{"none", 0}, shown.path);
}

/// Calls `act`; an Error about the frame names its file.
template <class Act>
auto about(const std::string& file, Act act) {
    try {
        return act();
    } catch (const Error& e) {
        throw e.kind() == ErrorKind::input && e.where().empty() ? Error(e.kind(), e.what(), file) : e;
    }
}

Frame read_noted(const std::string& path) {
    Frame frame = read_picture(path);
    for (const auto& note : frame.notes) spdlog::warn("{}: {}", path, note);
    return frame;
}

/// Adds the colours of a picture of its own as the frame's `pass`.
void add_pass(Frame& frame, const std::string& path, const std::string& pass) {
    if (path.empty()) return;
    Frame picture = read_noted(path);
    map_known_channels(picture);
    about(path, [&] {
        if (picture.window() != frame.window())
            throw Error(ErrorKind::input, fmt::format("has {} x {} pixels; expected {} x {}, as the frame", picture.width, picture.height,
                                                      frame.width, frame.height));
        const std::string to = pass == "normal" ? "XYZ" : "RGB";
        for (std::size_t c = 0; c < 3; ++c) {
            const std::string own = pass + "." + to[c], colour(1, "RGB"[c]);
            const std::vector<float>* const values = picture.has(own) ? picture.find(own) : picture.find(colour);
            if (!values) throw Error(ErrorKind::input, fmt::format("lacks channel {}", colour));
            frame.channels[own] = *values;
        }
    });
}

/// The input with clvr's names for its channels.
Frame input_frame(const DenoiseOptions& o) {
    Frame frame = read_noted(o.input);
    if (o.spp > 0) frame.attributes["clvr.spp"] = std::to_string(o.spp);
    about(o.input, [&] {
        for (const auto& mapping : o.map) map_channels(frame, mapping);
    });
    add_pass(frame, o.albedo, "albedo");
    add_pass(frame, o.normal, "normal");
    for (const auto& said : map_known_channels(frame)) spdlog::info("{}: {}", o.input, said);
    std::vector<std::string> has;
    for (const auto& [name, values] : frame.channels) has.push_back(name);
    for (const char* c : {"R", "G", "B"})
        if (!frame.has(c))
            throw Error(ErrorKind::input,
                        fmt::format("lacks channel {}: name its beauty as --map beauty=LAYER; it has {}", c, fmt::join(has, " ")), o.input);
    return frame;
}

/// "albedo normal depth" of their channels.
std::string layers_of(const std::vector<std::string>& channels) {
    std::string layers, last;
    for (const auto& channel : channels) {
        const std::string layer = channel.substr(0, channel.find('.'));
        if (layer != last) layers += (layers.empty() ? "" : " ") + layer;
        last = layer;
    }
    return layers;
}

/// All of them, read once.
const std::vector<std::pair<std::string, Model>>& models_inside() {
    static const auto all = [] {
        std::vector<std::pair<std::string, Model>> models;
        for (const auto& name : embedded_model_names()) models.emplace_back(name, read_model(name));
        return models;
    }();
    return all;
}

/// The model for the frame: `named`, else the first one inside clvr whose channels the frame has. Channels that the model reads and that
/// can be made are added to the frame, and named in `made`.
Model model_for(const DenoiseOptions& o, const std::optional<Model>& named, Frame& frame, std::vector<std::string>& made) {
    const auto keep = [&](const MadeChannels& channels) {
        if (!channels.said.empty()) spdlog::info("{}: {}", o.input, channels.said);
        made.insert(made.end(), channels.names.begin(), channels.names.end());
    };
    const auto choose = [&] { return about(o.input, [&] { return choose_model(models_inside(), frame); }); };
    if (!named) {
        keep(add_normal(frame));
        const ModelChoice choice = choose();
        if (choice.wants_samples)
            spdlog::info("{}: denoised by the model {}; --spp N, the samples per pixel, lets it take the one that reads more", o.input,
                         choice.name);
        else if (!choice.missing.empty())
            spdlog::info("{}: denoised by the model {}; for the one that reads the most it lacks {}", o.input, choice.name,
                         layers_of(choice.missing));
        else
            spdlog::info("{}: denoised by the model {}", o.input, choice.name);
        return choice.model;
    }
    keep(add_opacity(frame, *named));
    try {
        ChannelPlan(*named, false).check(frame);
    } catch (const Error& e) {
        throw Error(e.kind(), fmt::format("{}; --model {} reads only what it has", e.what(), choose().name), o.input);
    }
    return *named;
}

/// Has the device build, while the picture's pixels are read, the programs that its header asks for. A guess: a wrong one costs their time,
/// and what is wrong with the picture is said when it is read.
void prepare_for_header(const DenoiseOptions& o, const std::optional<Model>& named, const DenoiserView& view, const Device& device) {
    try {
        if (picture_format(o.input) != PictureFormat::exr) return;
        Frame header = exr_outline(o.input);
        if (o.spp > 0) header.attributes["clvr.spp"] = std::to_string(o.spp);
        const Model model = named ? *named : choose_model(models_inside(), header).model;
        Denoiser(device, model).prepare(header.width, header.height, header.has("variance.R"), view.levels);
    } catch (const Error& e) {
        spdlog::debug("{}: nothing is prepared: {}", o.input, e.what());
    }
}

void denoise(const DenoiseOptions& o) {
    if (o.outputs.empty())
        throw Error(ErrorKind::usage, "no output given: add -o picture.png (or .jpg, or .exr for all channels)", "clvr denoise");
    if (o.spp < 0 || o.spp > largest_spp)
        throw Error(ErrorKind::usage, fmt::format("is {}; expected 1 to {}", o.spp, largest_spp), "--spp");
    const DenoiserView view = view_of(o.show);
    PictureOutputs pictures(o.outputs, o.channels);
    std::optional<Model> named;
    if (!o.model.empty()) named = read_model(o.model);
    const Tonemap tonemap{o.tonemap.value_or(is_display_light(picture_format(o.input)) ? "none" : "filmic"), o.exposure};
    const ToneCurve known(tonemap);
    std::vector<Device> devices;
    std::exception_ptr no_device; // said after what is wrong with the file: reading it needs none
    try {
        devices = open_devices(o.device);
        prepare_for_header(o, named, view, devices.front());
    } catch (...) {
        no_device = std::current_exception();
    }
    Frame frame = input_frame(o);
    std::vector<std::string> made;
    const Model model = model_for(o, named, frame, made);
    if (no_device) std::rethrow_exception(no_device);
    std::size_t repaired = 0;
    frame = about(o.input, [&] {
        return on_first(devices, [&](Device& device) {
            Denoiser denoiser(device, model);
            Frame clean = denoiser.denoise(frame, view);
            repaired = denoiser.repaired();
            return clean;
        });
    });
    for (const auto& name : made) frame.channels.erase(name);
    if (repaired > 0) spdlog::warn("{}: {} values are not finite; taken as 0", o.input, repaired);
    std::vector<Shown> shown;
    if (!o.show.empty()) shown = shown_of(frame, o.outputs.front());
    for (const Shown& picture : shown) will_write(picture.path, "--show"); // their names come from the model
    pictures.write(frame, tonemap, o.outputs);
    for (const Shown& picture : shown) write_shown(frame, picture, tonemap);
    print_profiles(o.device, {devices.front()});
}

} // namespace

void add_denoise_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("denoise", "Denoise a picture with a trained network");
    auto o = std::make_shared<DenoiseOptions>();
    c->add_option("IN", o->input, "Noisy picture: .exr of any renderer, .hdr, .pfm, .png or .jpg")->type_name("FILE")->required();
    c->add_option("-o,--output", o->outputs, "Picture to write: .png, .jpg, or .exr with all channels (may be given twice)")
        ->type_name("FILE")
        ->group("Output");
    c->add_option("--model", o->model,
                  "Trained network: a .safetensors file, or one inside clvr: default, features, color-albedo-normal, color [by what the "
                  "picture has]")
        ->type_name("FILE|NAME")
        ->group("Network");
    c->add_option("--spp", o->spp, "Samples per pixel of a frame that does not say it (another renderer's)")->group("Network");
    c->add_option(
         "--map", o->map,
         "Take another renderer's channels: albedo=DiffCol, normal=N, beauty=Combined (may be given again) [usual names are known]")
        ->type_name("CLVR'S=THEIRS")
        ->delimiter(',')
        ->group("Network");
    c->add_option("--albedo", o->albedo, "Albedo in a picture of its own, as large")->type_name("FILE")->group("Network");
    c->add_option("--normal", o->normal, "Normals in a picture of its own: X Y Z as its R G B, -1 to 1")
        ->type_name("FILE")
        ->group("Network");
    c->add_option("--show", o->show, "Also write what the network made, beside the output (may be given again)")
        ->type_name("guides|weights|levels")
        ->delimiter(',')
        ->group("Output");
    add_channels_option(*c, o->channels);
    c->add_option("--exposure", o->exposure, "PNG and JPEG: exposure in stops [0]")->group("Output");
    c->add_option("--tonemap", o->tonemap, "PNG and JPEG: tone curve [filmic; none where IN is .png or .jpg]")
        ->type_name("filmic|aces|reinhard|none")
        ->group("Output");
    c->footer("Examples:\n"
              "  clvr denoise noisy.exr -o clean.exr\n"
              "  clvr denoise noisy.exr -o clean.png --model mine.safetensors\n"
              "  clvr denoise other.exr -o clean.exr --map albedo=DiffCol\n");
    add_device_options(*c, o->device, "denoise");
    reads_files(*c, {"IN", "--model", "--albedo", "--normal"});
    writes_files(*c, "--output");
    c->callback([o] { denoise(*o); });
}

} // namespace clvr
