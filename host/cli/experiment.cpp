// clvr experiment: a scene from nothing to a trained model and a report.
#include "host/cli/command_text.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/render_options.hpp"
#include "host/cli/source_commit.hpp"
#include "host/cli/stage_display.hpp"
#include "host/cli/volume_options.hpp"
#include "host/dataset/download.hpp"
#include "host/dataset/manifest.hpp"
#include "host/experiment/experiment_estimate.hpp"
#include "host/io/file_roles.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_text.hpp"
#include "runtime/system/signals.hpp"
#include "runtime/system/size.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct ExperimentOptions {
    RenderOptions picture; ///< of these --tf, --size, --seed
    std::string scene, scale = "quick", folder, volume, dims;
    std::optional<int> views, test_views, reference_spp, test_reference_spp, epochs, batch, patch;
    std::optional<std::int64_t> steps;
    std::optional<double> learning_rate;
    bool fetch = false, dry_run = false, json = false;
};

bool is_computed(const std::string& name) {
    const auto names = phantom_names();
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// The published volume that a scene's name means: its own name, or that of the computed one which stands in for it. Null: none.
const Dataset* published(const std::string& scene) {
    if (const Dataset* d = published_as(scene)) return d;
    for (const Dataset& d : datasets())
        if (d.name == scene) return &d;
    return nullptr;
}

/// Where the volume comes from: into settings.computed, or the path that is to be read.
std::string source_of(const ExperimentOptions& o, const Dataset* dataset, ExperimentSettings& s) {
    std::error_code failed;
    if (!o.volume.empty() && o.fetch) throw Error(ErrorKind::usage, "is given with --fetch; leave one of them out", "--volume");
    if (!o.volume.empty()) return fs::absolute(o.volume).string();
    if (o.fetch) {
        if (!dataset || dataset->url.empty())
            throw Error(ErrorKind::usage,
                        "is no volume that is published as a single file (`clvr dataset list` shows them); leave out --fetch", o.scene);
        return "../" + dataset->file_name();
    }
    if (is_computed(o.scene) || (dataset && !dataset->computed.empty())) {
        s.computed = is_computed(o.scene) ? o.scene : dataset->computed;
        return "../volume.nii";
    }
    if (dataset)
        throw Error(ErrorKind::usage, "is a published volume that nothing computed stands in for; add --fetch, or --volume FILE", o.scene);
    if (fs::exists(o.scene, failed)) return fs::absolute(o.scene).string();
    std::vector<std::string> names;
    for (const Dataset& d : datasets()) names.push_back(d.name);
    throw Error(ErrorKind::usage,
                fmt::format("is neither a scene nor a file; scenes are {}, and with --fetch {}", fmt::join(phantom_names(), ", "),
                            fmt::join(names, ", ")),
                o.scene);
}

ExperimentSettings settings_of(const ExperimentOptions& o) {
    ExperimentSettings s = scale_settings(o.scale);
    const Dataset* dataset = published(o.scene);
    const std::string volume = source_of(o, dataset, s);
    s.name = is_computed(o.scene) || dataset ? o.scene : fs::path(o.scene).stem().string();

    RenderOptions picture = o.picture;
    picture.input = "demo:" + o.scene; // no scene file is looked for
    if (!picture.size) picture.size = fmt::format("{}x{}", s.scene.width, s.scene.height);
    if (dataset && !picture.transfer && !dataset->transfer_function.empty()) picture.transfer = dataset->transfer_function;
    if (dataset) picture.zoom = dataset->zoom;
    s.scene = scene_of(picture);
    s.scene.volume = volume;
    if (dataset && fs::path(volume).extension() == ".raw") s.scene.reading.spacing = dataset->spacing; // its name has dims and type alone
    if (!s.computed.empty()) {
        s.size = phantom_size(s.computed);
        if (const Dataset* like = published_as(s.computed)) s.size = {like->dims, voxel_type_named(like->type).value_or(s.size.type)};
        s.size.dims = o.dims.empty() ? scaled_dims(s.size.dims, s.scale) : parse_dims(o.dims);
    } else if (!o.dims.empty())
        throw Error(ErrorKind::usage, "is for computed volumes; a file has its own", "--dims");

    const auto set = [](auto& field, const auto& option) {
        if (option) field = *option;
    };
    set(s.train.views, o.views), set(s.test.views, o.test_views);
    set(s.train.reference_spp, o.reference_spp), set(s.test.reference_spp, o.test_reference_spp);
    if (o.epochs && o.steps) throw Error(ErrorKind::usage, "is given with --epochs; leave one of them out", "--steps");
    if (o.epochs) s.training.steps = 0;
    set(s.training.epochs, o.epochs), set(s.training.steps, o.steps), set(s.training.step.batch, o.batch);
    set(s.training.step.patch, o.patch), set(s.training.learning_rate, o.learning_rate);
    s.training.seed = s.scene.seed;
    validate(s);
    return s;
}

void fetch(const ExperimentOptions& o, const std::string& folder, const std::atomic<bool>& interrupted) {
    const Dataset& d = *published(o.scene);
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw Error(ErrorKind::input, fmt::format("cannot be made: {}", failed.message()), folder);
    ProgressBar bar("fetching " + d.name, false);
    download(
        {d.url, (fs::path(folder) / d.file_name()).string(), d.bytes, d.sha512},
        [&](std::uint64_t there) {
            bar.update(static_cast<double>(there) / static_cast<double>(d.bytes), fmt::format("{} of {} MB", there >> 20, d.bytes >> 20));
        },
        &interrupted);
}

ordered_json to_json(const StageEstimate& e) {
    ordered_json j{{"stage", e.name}, {"seconds", e.seconds}, {"disk_bytes", e.disk_bytes}};
    if (e.paths > 0) j["paths"] = e.paths;
    if (e.steps > 0) j["steps"] = e.steps;
    return j;
}

void print_plan(const ExperimentSettings& s, const std::string& folder, const ExperimentEstimate& e, const std::string& device, bool json) {
    const StageEstimate total = e.total();
    if (json) {
        ordered_json stages = ordered_json::array();
        for (const StageEstimate& stage : e.stages) stages.push_back(to_json(stage));
        const ordered_json plan{{"scene", s.name},
                                {"scale", s.scale},
                                {"folder", folder},
                                {"device", device},
                                {"dims", e.dims},
                                {"type", voxel_type_name(e.type)},
                                {"volume_bytes", e.volume_bytes},
                                {"paths", total.paths},
                                {"training_steps", total.steps},
                                {"disk_bytes", total.disk_bytes},
                                {"device_bytes", e.device_bytes},
                                {"seconds", total.seconds},
                                {"probe_seconds", e.probe_seconds},
                                {"stages", stages}};
        fmt::print("{}", json_text(plan));
        return;
    }
    fmt::print("{}, scale {}, into {}\n", s.name, s.scale, folder);
    fmt::print("  device    {}, at most {} of its memory\n", device, size_text(e.device_bytes));
    fmt::print("  volume    {} {}, {}\n", fmt::join(e.dims, " x "), voxel_type_name(e.type), size_text(e.volume_bytes));
    fmt::print("  views     {} + {} of {}x{}, noisy at {} spp, references of {} and {} spp\n", s.train.views, s.test.views, s.scene.width,
               s.scene.height, fmt::join(s.spp, ", "), s.train.reference_spp, s.test.reference_spp);
    fmt::print("  training  {} steps of {} patches of {}x{}\n\n", total.steps, s.training.step.batch, s.training.step.patch,
               s.training.step.patch);
    fmt::print("{:<12} {:>12} {:>12} {:>14}\n", "stage", "time", "paths", "disk, at most");
    for (const StageEstimate& stage : e.stages)
        fmt::print("{:<12} {:>12} {:>12} {:>14}\n", stage.name, duration_text(stage.seconds),
                   stage.paths > 0 ? fmt::format("{:.1f} M", stage.paths * 1e-6) : "", stage.disk_bytes ? size_text(stage.disk_bytes) : "");
    fmt::print("{:<12} {:>12} {:>12} {:>14}\n", total.name, duration_text(total.seconds), fmt::format("{:.1f} M", total.paths * 1e-6),
               size_text(total.disk_bytes));
    fmt::print("\nEstimated from a probe of {}.\n", duration_text(e.probe_seconds));
}

void experiment(const ExperimentOptions& o, const std::string& command) {
    const ExperimentSettings settings = settings_of(o);
    const std::string folder = o.folder.empty() ? settings.name + "-" + settings.scale : o.folder;
    if (o.folder.empty()) // those of a folder that was named are known already
        for (const std::string& file : experiment_files(folder)) will_write(file, "clvr experiment");
    const std::atomic<bool>& interrupted = catch_interrupts();
    std::vector<Device> devices = open_devices(o.picture.devices);
    StageDisplay stages;
    const ExperimentControl control{
        interrupted, [&](const std::string& stage, double done, const std::string& note) { stages.update(stage, done, note); }};
    if (o.dry_run) {
        const ExperimentEstimate estimate = estimate_experiment(settings, folder, devices, control);
        stages.end();
        std::vector<std::string> names;
        for (const Device& d : devices) names.push_back(d.facts().name);
        print_plan(settings, folder, estimate, fmt::format("{}", fmt::join(names, " + ")), o.json);
        return;
    }
    if (o.fetch) fetch(o, folder, interrupted);
    const ExperimentOutcome outcome = run_experiment(settings, folder, devices, {CLVR_VERSION, source_commit(), command}, control);
    stages.end();
    if (!outcome.changed) spdlog::info("{} is finished: nothing was left to do", folder);
    if (o.json)
        fmt::print("{}", read_text((fs::path(folder) / "results.json").string()));
    else
        fmt::print("{}", outcome.table);
    print_profiles(o.picture.devices, devices);
}

} // namespace

void add_experiment_command(CLI::App& app) {
    CLI::App* c =
        app.add_subcommand("experiment", "Volume, views, training, measurement and report of a scene; goes on where it was interrupted");
    auto o = std::make_shared<ExperimentOptions>();
    c->add_option("SCENE", o->scene,
                  fmt::format("head, beetle, snake (the published scenes' computed stand-ins), {}, a published volume, or a volume file",
                              fmt::join(phantom_names(), ", ")))
        ->type_name("COMPUTED|DATASET|FILE")
        ->required();
    c->add_option("-o,--output", o->folder, "Folder to fill [SCENE-SCALE]")->type_name("DIR")->group("Output");
    c->add_option("--scale", o->scale,
                  "paper: the published protocol at full size; quick: a quarter of an hour on two cores; tiny: two minutes [quick]")
        ->type_name("paper|quick|tiny")
        ->group("Output");
    c->add_flag("--dry-run", o->dry_run, "Only print what it would take: paths, bytes, time by a short probe")->group("Output");
    c->add_flag("--json", o->json, "Print JSON")->group("Output");
    c->add_option("--volume", o->volume, "This file as the scene's volume")->type_name("FILE")->group("Volume");
    c->add_flag("--fetch", o->fetch, "Download the published volume into the folder")->group("Volume");
    c->add_option("--dims", o->dims,
                  "Voxels of a computed volume [paper, quick, tiny: those of the published one, half of them each way, 96 at most]")
        ->type_name("WxHxD")
        ->group("Volume");
    c->add_option("--tf", o->picture.transfer, "Transfer function: a preset's name, or a JSON file [the scene's, else from the histogram]")
        ->type_name("PRESET|FILE")
        ->group("Volume");
    c->add_option("--size", o->picture.size, "Size of the views [paper 512x512, quick 192x192, tiny 96x96]")
        ->type_name("WxH")
        ->group("Views");
    c->add_option("--views", o->views, "Training views [paper 100, quick 24, tiny 6]")->group("Views");
    c->add_option("--test-views", o->test_views, "Test views [paper 50, quick 8, tiny 3]")->group("Views");
    c->add_option("--reference-spp", o->reference_spp, "Samples per pixel of the training references [paper 1024, quick 256, tiny 64]")
        ->group("Views");
    c->add_option("--test-reference-spp", o->test_reference_spp,
                  "Samples per pixel of the test references [paper 4096, quick 1024, tiny 64]")
        ->group("Views");
    c->add_option("--seed", o->picture.seed, "Of views, noise, initialisation and patches [0]")->group("Views");
    c->add_option("--epochs", o->epochs, "Epochs of 50 patches a view [paper 200]")->group("Training");
    c->add_option("--steps", o->steps, "Steps, in place of epochs [quick 3000, tiny 600]")->group("Training");
    c->add_option("--batch", o->batch, "Patches a step [paper 128, quick 8, tiny 4]")->group("Training");
    c->add_option("--patch", o->patch, "Width and height of a patch [paper 256, quick 128, tiny 64]")->group("Training");
    c->add_option("--lr", o->learning_rate, "Learning rate of Adam [paper 0.0001, constant; else 0.001, falling along a cosine]")
        ->group("Training");
    c->footer("Examples:\n"
              "  clvr experiment snake --scale tiny\n"
              "  clvr experiment beetle --scale paper --dry-run\n"
              "  clvr experiment stag_beetle --fetch --scale paper\n"
              "  clvr experiment scan.nii.gz -o mine\n");
    add_device_options(*c, o->picture.devices, "train");
    reads_files(*c, {"SCENE", "--volume", "--tf"});
    writes_files(*c, "--output", experiment_files);
    c->callback([o, c] { experiment(*o, command_text(*c)); });
}

} // namespace clvr
