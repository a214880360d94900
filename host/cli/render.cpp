// clvr render: a volume or a scene to pictures.
#include "host/cli/commands.hpp"
#include "host/cli/first_word.hpp"
#include "host/cli/open_volume.hpp"
#include "host/cli/picture_outputs.hpp"
#include "host/cli/progress_bar.hpp"
#include "host/cli/provenance.hpp"
#include "host/cli/render_options.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/io/scene/scene_inputs.hpp"
#include "host/render/params.hpp"
#include "host/render/pipeline.hpp"
#include "host/render/session.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/signals.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <optional>

namespace clvr {

namespace {

void print_presets() {
    for (const auto& p : transfer_presets()) fmt::print("{:<16} {}\n", p.name, p.description);
}

/// Renders one view and writes it to all outputs. Returns the samples reached.
int render_view(RenderSession& session, Pipeline& pipeline, const Scene& scene, const RenderOptions& o,
                const std::atomic<bool>& interrupted, PictureOutputs& pictures, const std::vector<std::string>& outputs,
                const std::string& label) {
    const bool any_exr = std::any_of(outputs.begin(), outputs.end(), is_exr_path);
    Scene wanted = scene;
    wanted.features &= any_exr; // a PNG alone does not need them
    {
        ProgressBar bar(label, false);
        const double paths = static_cast<double>(scene.width) * scene.height * scene.spp;
        RenderControl control;
        control.seconds = o.seconds;
        control.cancelled = &interrupted;
        control.light = any_exr;
        std::atomic<int> reached{0};
        control.progress = [&](const RenderProgress& p) {
            if (reached.exchange(p.samples) < p.samples) spdlog::debug("{} samples per pixel done", p.samples);
            const double share = o.seconds > 0 ? std::min(1.0, bar.seconds() / o.seconds) : p.done;
            bar.update(share, fmt::format("{} spp, {:.2f} Mpaths/s", p.samples, p.done * paths / bar.seconds() * 1e-6));
        };
        pipeline.run(session, wanted, control);
    }
    Scene made = scene;
    made.spp = scene.mode == Mode::path ? session.samples() : scene.spp;
    const Tonemap tonemap{made.tonemap, made.exposure};
    if (any_exr) {
        Frame frame = session.frame(scene.background);
        add_provenance(frame, made, to_json(made), session.devices());
        pictures.write(frame, tonemap, outputs);
    } else {
        pictures.write([&](bool alpha) { return session.picture(scene.background, tonemap, alpha); }, outputs);
    }
    return made.spp;
}

/// The picture beside the volume, where there is none yet. Throws Error{usage}.
std::string new_picture_beside(const RenderOptions& o) {
    const std::string picture = picture_beside(o.input);
    std::error_code failed;
    if (std::filesystem::exists(o.turntable > 0 ? view_path(picture, 0) : picture, failed))
        throw Error(ErrorKind::usage, "exists; add -o " + picture + " to replace it, or -o with another name", picture);
    return picture;
}

void render(RenderOptions o) {
    if (o.list_transfer) return print_presets();
    if (o.input.empty())
        throw Error(ErrorKind::usage, "no volume given: name a file or folder, or demo:head for the built-in one", "clvr render");
    if (o.outputs.empty() && o.beside) {
        o.outputs.push_back(new_picture_beside(o));
        for (const std::string& path : view_paths(o.outputs.front(), o.turntable)) will_write(path, "clvr render");
    }
    if (o.outputs.empty())
        throw Error(ErrorKind::usage, "no output given: add -o picture.png (or .jpg, or .exr for all channels)", "clvr render");
    if (o.turntable < 0 || o.turntable > largest_turntable)
        throw Error(ErrorKind::usage, fmt::format("is {}; expected 1 to {}", o.turntable, largest_turntable), "--turntable");
    if (!(o.seconds >= 0)) throw Error(ErrorKind::usage, fmt::format("is {}; expected a positive number of seconds", o.seconds), "--time");
    Scene scene = scene_of(o);
    if (o.denoise && scene.mode != Mode::path) throw Error(ErrorKind::usage, "is for path traced pictures; leave out --mode", "--denoise");
    std::optional<Model> model;
    if (o.denoise) model = read_model(o.model);
    PictureOutputs pictures(o.outputs, o.channels, " (or over --background)");
    if (!o.save_scene.empty()) check_writable(o.save_scene);
    const bool any_exr = std::any_of(o.outputs.begin(), o.outputs.end(), is_exr_path);

    const std::atomic<bool>& interrupted = catch_interrupts();
    std::vector<std::string> notes;
    const EnvironmentTables environment = read_environment(scene, &notes);
    for (const auto& note : notes) spdlog::debug("{}: {}", scene.light.image, note);
    std::vector<Device> devices = open_devices(o.devices);
    const PreparedVolume volume(open_volume(scene.volume, scene.reading, devices));
    if (any_exr || !o.save_scene.empty() || !scene.volume_sha256.empty()) {
        const std::string hash = volume_sha256(volume.voxels);
        if (!scene.volume_sha256.empty() && scene.volume_sha256 != hash)
            throw Error(
                ErrorKind::input,
                fmt::format("does not hold the voxels that the scene was saved with (SHA-256 {}, expected {})", hash, scene.volume_sha256),
                scene.volume);
        scene.volume_sha256 = hash;
    }
    // Resolved, so that a saved scene does not depend on later defaults.
    if (!scene.transfer) scene.transfer = automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels));
    scene.extinction = resolved_extinction(scene, volume.voxels);

    RenderSession session(devices, volume, scene, environment, o.turntable > 0);
    for (const auto& w : session.warnings()) spdlog::warn("{}", w);

    Pipeline pipeline(model);
    const double azimuth = scene.camera.azimuth;
    int reached = 0;
    for (int view = 0; view < std::max(1, o.turntable) && !interrupted; ++view) {
        std::vector<std::string> outputs = o.outputs;
        if (o.turntable > 0) {
            for (auto& path : outputs) path = view_path(path, view);
            scene.camera.azimuth = azimuth + 360.0 * view / o.turntable;
            scene.view = view;
            session.set_view(scene, true);
        }
        reached = render_view(session, pipeline, scene, o, interrupted, pictures, outputs,
                              o.turntable > 0 ? fmt::format("view {}/{}", view + 1, o.turntable) : "rendering");
    }
    if (!o.save_scene.empty()) {
        scene.camera.azimuth = azimuth;
        scene.view = 0;
        scene.spp = reached;
        write_scene(scene, o.save_scene);
    }
    print_profiles(o.devices, devices);
    if (interrupted)
        throw Error(ErrorKind::interrupted, fmt::format("interrupted; saved what was finished, {} samples per pixel", reached));
}

} // namespace

void add_render_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render a volume to a picture");
    auto options = std::make_shared<RenderOptions>();
    add_render_options(*command, *options);
    command->footer("Transfer functions:\n"
                    "  A JSON file of points over the volume's values; between them, colour and\n"
                    "  opacity change linearly, outside they stay as at the ends:\n"
                    "\n"
                    "  {\"domain\": \"physical\",\n"
                    "   \"points\": [{\"value\": 150, \"color\": [0.9, 0.5, 0.4], \"opacity\": 0},\n"
                    "              {\"value\": 300, \"color\": [0.9, 0.8, 0.7], \"opacity\": 0.4}]}\n"
                    "\n"
                    "  Values are the file's own, such as Hounsfield units; with \"domain\":\n"
                    "  \"normalized\", 0 to 1 of the volume's range. Colours are red, green, blue from\n"
                    "  0 to 1 in sRGB, as colour pickers show them; \"color_space\": \"linear\" beside\n"
                    "  \"domain\" says that they are linear (albedo 0.5 linear is 0.735 in sRGB).\n"
                    "World space:\n"
                    "  --eye, --target and --clip-plane are in LPS millimetres: x grows to the\n"
                    "  patient's left, y to the back, z to the head. `clvr info` shows where the\n"
                    "  volume lies.\n"
                    "Examples:\n"
                    "  clvr render scan.nii.gz -o scan.png --denoise --spp 4\n"
                    "  clvr render scans/ -o knee.png --tf ct-bone --azimuth 90 --zoom 1.5\n"
                    "  clvr render head.mha -o head.exr -o head.png --tf mine.json --time 30\n"
                    "  clvr render demo:head -o turn.png --turntable 72 --background \"#202020\"\n"
                    "  clvr render scan.nii.gz -o in.png --eye 0,-400,40 --target 0,0,40\n");
    command->callback([options] { render(*options); });
}

} // namespace clvr
