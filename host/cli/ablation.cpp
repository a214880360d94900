// clvr ablation: what each channel and switch of the network brings. A command of its own beside `clvr experiment`, because it takes pairs
// of several volumes, which belong to no scene.
#include "host/experiment/ablation.hpp"
#include "host/cli/command_text.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/device_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/source_commit.hpp"
#include "host/cli/stage_display.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/signals.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace clvr {

namespace {

struct AblationOptions {
    AblationSettings settings;
    std::string folder;
    bool json = false;
    DeviceOptions device;

    AblationOptions() { settings.training = ablation_training(); }
};

void check(const AblationOptions& o) {
    const auto range = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw Error(ErrorKind::usage, fmt::format("is {}; expected {} to {}", value, low, high), name);
    };
    const TrainerConfig& t = o.settings.training;
    if (o.settings.train.empty()) throw Error(ErrorKind::usage, "no folder given: name those that `clvr pairs` made", "clvr ablation");
    if (o.settings.test.empty()) throw Error(ErrorKind::usage, "no test folder given: add --test DIR", "clvr ablation");
    if (o.folder.empty()) throw Error(ErrorKind::usage, "no output given: add -o DIR", "clvr ablation");
    range("--steps", static_cast<double>(t.steps), 1, 1e9);
    range("--batch", t.step.batch, 1, 65536);
    range("--patch", t.step.patch, 1, 4096);
    range("--lr", t.learning_rate, 1e-12, 10);
    for (const int spp : o.settings.spp) range("--spp", spp, 1, 1 << 20);
}

void ablation(const AblationOptions& o, const std::string& command) {
    check(o);
    const std::atomic<bool>& interrupted = catch_interrupts();
    const Device device = open_device(o.device);
    StageDisplay display;
    const ExperimentControl control{
        interrupted, [&](const std::string& stage, double done, const std::string& note) { display.update(stage, done, note); }};
    const std::vector<AblationResult> results =
        run_ablation(o.settings, o.folder, device, {CLVR_VERSION, source_commit(), command}, control);
    display.end();
    if (o.json)
        fmt::print("{}", read_text((std::filesystem::path(o.folder) / "ablation.json").string()));
    else
        fmt::print("{}", markdown_tables(results));
    print_profiles(o.device, {device});
}

} // namespace

void add_ablation_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand(
        "ablation",
        "Train the network with fewer or other input channels and switches, and measure each; goes on where it was interrupted");
    auto o = std::make_shared<AblationOptions>();
    AblationSettings& s = o->settings;
    c->add_option("DIR", s.train, "Folders of training pairs")->type_name("DIR");
    c->add_option("-o,--output", o->folder, "Folder to fill")->type_name("DIR")->group("Output");
    c->add_flag("--json", o->json, "Print JSON")->group("Output");
    c->add_option("--test", s.test, "Folder of test pairs (may be given again)")->type_name("DIR")->group("Measuring");
    c->add_option("--spp", s.spp, "Measure at the noisy frames of these samples per pixel [1,4]")
        ->type_name("N,...")
        ->delimiter(',')
        ->group("Measuring");
    std::string names;
    for (const AblationRow& row : ablation_rows()) names += (names.empty() ? "" : ", ") + row.name;
    c->add_option("--rows", s.rows, "Only some of: " + names + " [all but the last]")
        ->type_name("ROW,...")
        ->delimiter(',')
        ->group("Measuring");
    c->add_option("--steps", s.training.steps, "Steps of each training [1500]")->group("Training");
    c->add_option("--batch", s.training.step.batch, "Patches a step [8]")->group("Training");
    c->add_option("--patch", s.training.step.patch, "Width and height of a patch [128]")->group("Training");
    c->add_option("--lr", s.training.learning_rate, "Learning rate of Adam, falling along a cosine [0.001]")->group("Training");
    c->add_option("--seed", s.training.seed, "Of initialisation and patches [0]")->group("Training");
    c->footer("Examples:\n"
              "  clvr ablation train1 train2 --test test1 --test test2 -o ablation\n");
    add_device_options(*c, o->device, "train");
    reads_files(*c, {"DIR", "--test"});
    writes_files(*c, "--output", ablation_files);
    c->callback([o, c] { ablation(*o, command_text(*c)); });
}

} // namespace clvr
