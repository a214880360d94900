// clvr pairs: views around a volume as noisy frames and references, to train and test denoisers on.
#include "host/train/pairs.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/interrupt.hpp"
#include "host/cli/open_volume.hpp"
#include "host/cli/progress_bar.hpp"
#include "host/cli/render_options.hpp"
#include "host/io/atomic_file.hpp"
#include "host/io/frame_file.hpp"
#include "host/io/scene_file.hpp"
#include "host/render/params.hpp"
#include "host/render/renderer.hpp"
#include "host/render/view_set.hpp"
#include "runtime/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

namespace clvr {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Options {
    RenderOptions scene;
    std::string folder, split = "train", zoom_range = "1,1";
    std::vector<std::string> variations;
    std::vector<int> noisy_spp;
    int views = 100, reference_spp = 1024, noisy_frames = 1;
};

/// All that decides the frames of a folder: what pairs.json holds.
struct Plan {
    std::string split;
    std::vector<int> spp{1}; ///< of the noisy frames, in turn
    int reference_spp = 1024, noisy_frames = 1;
    std::uint64_t seed = 0;
    std::vector<Scene> scenes; ///< one per transfer function; view v is of scene v modulo their number
    std::vector<ViewPoint> views;
};

/// Independent for every frame of a view, of the reference (role 0) and the noisy ones (1 ..).
std::uint64_t seed_of(const Plan& plan, int role) {
    return plan.seed + (plan.split == "test" ? 0x8000000000000000u : 0) + static_cast<std::uint64_t>(role) * 0x9e3779b97f4a7c15u;
}

std::string to_json(const Plan& p) {
    ordered_json views = ordered_json::array(), scenes = ordered_json::array();
    for (const auto& v : p.views) views.push_back({{"azimuth", v.azimuth}, {"elevation", v.elevation}, {"zoom", v.zoom}});
    for (const auto& s : p.scenes) scenes.push_back(ordered_json::parse(to_json(s)));
    const ordered_json all{{"clvr.format", "pairs/1"},       {"split", p.split}, {"spp", p.spp},   {"reference_spp", p.reference_spp},
                           {"noisy_frames", p.noisy_frames}, {"seed", p.seed},   {"views", views}, {"scenes", scenes}};
    return all.dump(1) + "\n";
}

Plan parse_plan(const std::string& text, const std::string& where) {
    try {
        const auto j = nlohmann::json::parse(text);
        if (j.at("clvr.format") != "pairs/1") throw Error(ErrorKind::input, "is of another format; expected pairs/1", where);
        Plan p{j.at("split").get<std::string>(),
               j.at("spp").get<std::vector<int>>(),
               j.at("reference_spp").get<int>(),
               j.at("noisy_frames").get<int>(),
               j.at("seed").get<std::uint64_t>(),
               {},
               {}};
        for (const auto& v : j.at("views"))
            p.views.push_back({v.at("azimuth").get<double>(), v.at("elevation").get<double>(), v.at("zoom").get<double>()});
        for (const auto& s : j.at("scenes")) p.scenes.push_back(parse_scene(s.dump(), where));
        if (p.views.empty() || p.scenes.empty() || p.spp.empty()) throw Error(ErrorKind::input, "names no views", where);
        return p;
    } catch (const nlohmann::json::exception& e) {
        throw Error(ErrorKind::input, fmt::format("is no pairs.json: {}", e.what()), where);
    }
}

bool is_plan(const std::string& path) { return fs::path(path).filename() == "pairs.json"; }

Plan plan_of(const Options& o) {
    if (is_plan(o.scene.input)) return parse_plan(read_text(o.scene.input), o.scene.input);
    const auto check = [](const char* name, int value, int low, int high) {
        if (value < low || value > high) throw Error(ErrorKind::usage, fmt::format("is {}; expected {} to {}", value, low, high), name);
    };
    check("--views", o.views, 1, 100000);
    check("--reference-spp", o.reference_spp, 0, largest_spp);
    check("--noisy-frames", o.noisy_frames, 1, 1000);
    if (o.reference_spp == 0 && o.noisy_frames < 2)
        throw Error(ErrorKind::usage, "is 0, so another noisy frame must serve as target: add --noisy-frames 2 or more", "--reference-spp");
    if (o.split != "train" && o.split != "test")
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected train or test", o.split), "--split");
    double low = 0, high = 0;
    char end = 0;
    if (std::sscanf(o.zoom_range.c_str(), "%lf,%lf%c", &low, &high, &end) != 2 || !(low > 0 && low <= high && high <= 100))
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected LOW,HIGH above 0", o.zoom_range), "--zoom-range");
    Plan p;
    p.split = o.split;
    p.reference_spp = o.reference_spp;
    p.noisy_frames = o.noisy_frames * static_cast<int>(std::max<std::size_t>(1, o.noisy_spp.size()));
    for (const int spp : o.noisy_spp) check("--noisy-spp", spp, 1, largest_spp);
    RenderOptions options = o.scene;
    if (!options.spp) options.spp = 1;
    for (std::size_t k = 0; k < std::max<std::size_t>(1, o.variations.size()); ++k) {
        if (!o.variations.empty()) options.transfer = o.variations[k];
        p.scenes.push_back(scene_of(options));
    }
    Scene& first = p.scenes.front();
    if (first.mode != Mode::path) throw Error(ErrorKind::usage, "is for path traced pictures", "--mode");
    p.spp = o.noisy_spp.empty() ? std::vector<int>{first.spp} : o.noisy_spp;
    p.seed = first.seed;
    p.views = view_set(o.views, p.seed + (p.split == "test" ? 0x5bd1e995u : 0), low, high);
    for (Scene& s : p.scenes) {
        s.camera.eye = s.camera.target = std::nullopt;
        if (!is_demo_volume(s.volume)) s.volume = fs::absolute(s.volume).string();
    }
    return p;
}

/// Settles the defaults that depend on the voxels, so that pairs.json does not depend on later ones.
void resolve(Plan& plan, const PreparedVolume& volume) {
    const std::string hash = volume_sha256(volume.voxels);
    for (Scene& s : plan.scenes) {
        if (!s.volume_sha256.empty() && s.volume_sha256 != hash)
            throw Error(ErrorKind::input,
                        fmt::format("does not hold the voxels of the pairs (SHA-256 {}, expected {})", hash, s.volume_sha256), s.volume);
        s.volume_sha256 = hash;
        if (!s.transfer) s.transfer = automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels));
        s.extinction = resolved_extinction(s, volume.voxels);
    }
}

void check_folder(const std::string& folder, const std::string& plan) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw Error(ErrorKind::input, fmt::format("cannot be made: {}", failed.message()), folder);
    const std::string path = (fs::path(folder) / "pairs.json").string();
    if (!fs::exists(path)) return write_atomically(path, plan.data(), plan.size());
    if (read_text(path) != plan)
        throw Error(ErrorKind::input, "holds pairs made with other settings; name another folder, or remove this one", folder);
}

/// One frame of a view; nothing when interrupted before it was complete.
std::optional<Frame> frame_of(Renderer& renderer, const Scene& scene, const std::atomic<bool>& interrupted) {
    RenderControl control;
    control.cancelled = &interrupted;
    try {
        Frame frame = renderer.render(control);
        if (std::stoi(frame.attributes.at("clvr.spp")) < scene.spp) return std::nullopt;
        frame.attributes["clvr.scene"] = provenance_json(scene);
        frame.attributes["clvr.seed"] = std::to_string(scene.seed);
        frame.attributes["clvr.volume.sha256"] = scene.volume_sha256;
        return frame;
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::interrupted) return std::nullopt;
        throw;
    }
}

void pairs(const Options& o) {
    if (o.folder.empty()) throw Error(ErrorKind::usage, "no folder given: add -o DIR", "clvr pairs");
    if (o.scene.input.empty())
        throw Error(ErrorKind::usage, "no volume given: name a file or folder, or demo:head for the built-in one", "clvr pairs");
    Plan plan = plan_of(o);
    const std::atomic<bool>& interrupted = catch_interrupts();
    std::vector<Device> devices = open_devices(o.scene.devices);
    const Scene& first = plan.scenes.front();
    EnvironmentTables environment;
    if (first.light.environment == Light::Environment::image) {
        const RgbImage image = read_environment_image(first.light.image);
        environment = environment_tables(image.width, image.height, image.rgb, first.light.level);
    }
    const PreparedVolume volume(open_volume(
        first.volume, {first.frame, first.series, first.allow_gaps, first.raw.dims, first.raw.type, first.raw.spacing, first.raw.endian},
        devices.front()));
    resolve(plan, volume);
    check_folder(o.folder, to_json(plan));

    const int count = static_cast<int>(plan.views.size()), kinds = static_cast<int>(plan.scenes.size());
    ProgressBar bar("pairs", false);
    int done = 0;
    for (int kind = 0; kind < kinds && !interrupted; ++kind) {
        // Noisy frames with features and references without them, each with the volume's one upload: a renderer for either.
        std::optional<Renderer> noisy, reference;
        for (int v = kind; v < count && !interrupted; v += kinds, ++done)
            for (int role = plan.reference_spp > 0 ? 0 : 1; role <= plan.noisy_frames && !interrupted; ++role) {
                const std::string path = (fs::path(o.folder) / (role == 0 ? reference_name(v) : noisy_name(v, role - 1))).string();
                if (fs::exists(path)) continue;
                Scene scene = plan.scenes[static_cast<std::size_t>(kind)];
                scene.seed = seed_of(plan, role);
                scene.spp = role == 0 ? plan.reference_spp : plan.spp[static_cast<std::size_t>(role - 1) % plan.spp.size()];
                scene.features = role != 0;
                scene.camera.azimuth = plan.views[v].azimuth;
                scene.camera.elevation = plan.views[v].elevation;
                scene.camera.zoom *= plan.views[v].zoom;
                scene.view = v;
                (role == 0 ? reference : noisy).reset();
                Renderer& renderer = (role == 0 ? reference : noisy).emplace(devices, volume, scene, environment);
                bar.update(static_cast<double>(done) / count, fmt::format("view {} of {}", done + 1, count));
                const std::optional<Frame> frame = frame_of(renderer, scene, interrupted);
                if (frame) write_exr(*frame, path);
            }
    }
    print_profiles(o.scene.devices, devices);
    if (interrupted)
        throw Error(ErrorKind::interrupted,
                    fmt::format("interrupted; the same command goes on from here ({} of {} views done)", done - 1, count));
}

} // namespace

void add_pairs_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("pairs", "Render views around a volume as noisy frames and references, for training and testing");
    auto o = std::make_shared<Options>();
    c->add_option("-o,--output", o->folder, "Folder to fill; an unfinished one is gone on with")->type_name("DIR");
    c->add_option("--views", o->views, "Number of views [100]")->group("Pairs");
    c->add_option("--reference-spp", o->reference_spp, "Samples per pixel of the references; 0: none [1024]")->group("Pairs");
    c->add_option("--noisy-frames", o->noisy_frames, "Independent noisy frames of each view [1]")->group("Pairs");
    c->add_option("--noisy-spp", o->noisy_spp, "Samples per pixel of several noisy frames a view, as 1,2,4,8 [one of --spp]")
        ->type_name("LIST")
        ->delimiter(',')
        ->group("Pairs");
    c->add_option("--split", o->split, "train or test: other views, other noise [train]")->group("Pairs");
    c->add_option("--zoom-range", o->zoom_range, "Zooms of the views, uniform [1,1]")->type_name("LOW,HIGH")->group("Pairs");
    c->add_option("--vary-tf", o->variations, "Transfer functions (presets or files) that the views take in turn")
        ->type_name("NAME|FILE")
        ->group("Pairs");
    add_scene_options(*c, o->scene);
    c->callback([o] { pairs(*o); });
}

} // namespace clvr
