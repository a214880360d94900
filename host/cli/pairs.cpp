// clvr pairs: views around a volume as noisy frames and references, to train and test denoisers on.
#include "host/cli/commands.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/open_volume.hpp"
#include "host/cli/progress_bar.hpp"
#include "host/cli/render_options.hpp"
#include "host/io/scene/scene_inputs.hpp"
#include "host/pairs/folder.hpp"
#include "host/pairs/rendering.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/signals.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

namespace clvr {

namespace {

namespace fs = std::filesystem;

struct PairsOptions {
    RenderOptions scene;
    std::string folder, split = "train", zoom_range = "1,1";
    std::vector<std::string> variations;
    std::vector<int> noisy_spp;
    int views = 100, reference_spp = 1024, noisy_frames = 1;
};

bool is_plan(const std::string& path) { return fs::path(path).filename() == "pairs.json"; }

/// The files in the folder that the command may overwrite: its frames, and the plan unless an earlier one is continued.
std::vector<std::string> written_in(const std::string& folder, bool goes_on) {
    std::vector<std::string> files;
    if (!goes_on) files.push_back((fs::path(folder) / "pairs.json").string());
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (is_frame_name(entry.path().filename().string())) files.push_back(entry.path().string());
    return files;
}

PairsPlan plan_of(const PairsOptions& o) {
    if (is_plan(o.scene.input)) return parse_pairs_plan(read_text(o.scene.input), o.scene.input);
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
    PairsPlan p;
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
    p.views = split_views(p.split, p.seed, o.views, low, high);
    for (Scene& s : p.scenes) {
        s.camera.eye = s.camera.target = std::nullopt;
        if (!is_demo_volume(s.volume)) s.volume = fs::absolute(s.volume).string();
    }
    return p;
}

void pairs(const PairsOptions& o) {
    if (o.folder.empty()) throw Error(ErrorKind::usage, "no folder given: add -o DIR", "clvr pairs");
    if (o.scene.input.empty())
        throw Error(ErrorKind::usage, "no volume given: name a file or folder, or demo:head for the built-in one", "clvr pairs");
    PairsPlan plan = plan_of(o);
    const std::atomic<bool>& interrupted = catch_interrupts();
    std::vector<Device> devices = open_devices(o.scene.devices);
    const Scene& first = plan.scenes.front();
    std::vector<std::string> notes;
    const EnvironmentTables environment = read_environment(first, &notes);
    for (const auto& note : notes) spdlog::debug("{}: {}", first.light.image, note);
    const PreparedVolume volume(open_volume(first.volume, first.reading, devices));
    settle(plan, volume);
    begin_pairs_folder(o.folder, plan);

    const int count = static_cast<int>(plan.views.size());
    int done = 0;
    {
        ProgressBar bar("pairs", false);
        done = render_pairs(devices, volume, environment, plan, o.folder, interrupted, [&](int before) {
            bar.update(static_cast<double>(before) / count, fmt::format("view {} of {}", before + 1, count));
        });
    }
    print_profiles(o.scene.devices, devices);
    if (done < count)
        throw Error(ErrorKind::interrupted,
                    fmt::format("interrupted; the same command goes on from here ({} of {} views done)", done, count));
}

} // namespace

void add_pairs_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("pairs", "Render views around a volume as noisy frames and references, for training and testing");
    auto o = std::make_shared<PairsOptions>();
    c->add_option("-o,--output", o->folder, "Folder to fill; an unfinished one is continued")->type_name("DIR")->group("Output");
    c->add_option("--views", o->views, "Number of views [100]")->group("Pairs");
    c->add_option("--reference-spp", o->reference_spp, "Samples per pixel of the references; 0: none [1024]")->group("Pairs");
    c->add_option("--noisy-frames", o->noisy_frames, "Independent noisy frames of each view [1]")->group("Pairs");
    c->add_option("--noisy-spp", o->noisy_spp, "Samples per pixel of several noisy frames a view, as 1,2,4,8 [one of --spp]")
        ->type_name("N,...")
        ->delimiter(',')
        ->group("Pairs");
    c->add_option("--split", o->split, "Training and test pairs have other views and other noise [train]")
        ->type_name("train|test")
        ->group("Pairs");
    c->add_option("--zoom-range", o->zoom_range, "Zooms of the views, uniform [1,1]")->type_name("LOW,HIGH")->group("Pairs");
    c->add_option("--vary-tf", o->variations, "Transfer functions that the views take in turn (may be given again)")
        ->type_name("PRESET|FILE")
        ->group("Pairs");
    add_scene_options(*c, o->scene);
    c->footer("Examples:\n"
              "  clvr pairs scan.nii.gz -o train --views 24 --size 256x256 --reference-spp 256\n"
              "  clvr pairs scan.nii.gz -o test --views 8 --split test --noisy-spp 1,2,4,8\n"
              "  clvr pairs train/pairs.json -o copy   # the same pairs again\n");
    reads_files(*c, {"--vary-tf"});
    writes_files(*c, "--output", [o](const std::string& folder) { return written_in(folder, is_plan(o->scene.input)); });
    c->callback([o] { pairs(*o); });
}

} // namespace clvr
