// clvr eval: what denoisers reach on a folder of test pairs.
#include "host/cli/commands.hpp"
#include "host/cli/device_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/progress_bar.hpp"
#include "host/eval/evaluation_json.hpp"
#include "host/eval/report.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/train/trainer.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_text.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct EvalOptions {
    std::string folder, tune, report;
    std::vector<std::string> models;
    Tonemap tonemap;
    int frame = 0;
    bool json = false;
    DeviceOptions device;
};

ordered_json json_of(const Evaluation& e, const EvalOptions& o, const Baselines& b) {
    ordered_json all{{"folder", o.folder}, {"models", o.models}};
    all.update(to_json(b));
    all.update(to_json(e));
    return all;
}

void print_table(const Evaluation& e) {
    fmt::print("{:<18}", fmt::format("mean of {} views", e.views.size()));
    for (const auto& [name, value] : named(Metrics())) fmt::print(" {:>11}", name);
    fmt::print("\n");
    for (const Score& s : e.scores) {
        fmt::print("{:<18}", s.name);
        for (const auto& [name, value] : named(s.mean)) fmt::print(" {:>11.4f}", value);
        fmt::print("\n");
    }
}

/// Names of models in tables: their files' stems, or whole paths where stems are the same.
std::vector<std::string> names_of(const std::vector<std::string>& paths) {
    std::vector<std::string> names;
    for (const auto& path : paths) {
        const std::string stem = fs::path(path).stem().string();
        int as = 0;
        for (const auto& other : paths) as += fs::path(other).stem() == fs::path(path).stem();
        names.push_back(as > 1 ? path : stem);
    }
    return names;
}

void eval(EvalOptions o) {
    if (o.models.empty()) o.models = {"default"};
    if (!o.report.empty()) check_writable(o.report);
    const ToneCurve known(o.tonemap);
    std::vector<std::pair<std::string, Model>> models;
    std::vector<std::pair<std::string, std::string>> trainings;
    const std::vector<std::string> names = names_of(o.models);
    for (std::size_t k = 0; k < o.models.size(); ++k) {
        models.emplace_back(names[k], read_model(o.models[k]));
        const std::string csv = training_csv(o.models[k]);
        if (!fs::is_regular_file(csv)) continue;
        will_read(csv);
        trainings.emplace_back(names[k], read_text(csv));
    }
    Device device = open_device(o.device);
    Baselines baselines;
    if (!o.tune.empty()) {
        ProgressBar bar("choosing the baselines' settings", false);
        baselines = best_baselines(device, o.tune, o.frame, [&](double done) { bar.update(done, ""); });
    }
    const std::vector<Candidate> all = candidates(device, models, baselines);
    Evaluation e;
    {
        ProgressBar bar("evaluating", false);
        e = evaluate(all, o.folder, o.frame, [&](double done) { bar.update(done, ""); });
    }
    if (!o.report.empty()) {
        ReportOptions r;
        r.title = fmt::format("{} on {}", fmt::join(names, ", "), o.folder);
        r.notes = {fmt::format("device: {}", device.facts().name),
                   fmt::format("cross-bilateral: sigma {} pixels, features {}; wavelet: colour {}, features {}{}",
                               baselines.cross_bilateral.spatial, baselines.cross_bilateral.feature, baselines.wavelet.colour,
                               baselines.wavelet.feature, o.tune.empty() ? " (defaults)" : fmt::format(" (best of 3x3 on {})", o.tune)),
                   "PSNR and SSIM of clip(RGB, 0, 1)^(1/2.2) over black; RMSE, SMAPE and relMSE linear"};
        r.tonemap = o.tonemap;
        r.trainings = trainings;
        const std::string html = html_report({{"", o.frame, e, all}}, o.folder, r);
        write_atomically(o.report, html);
    }
    if (o.json)
        fmt::print("{}", json_text(json_of(e, o, baselines)));
    else
        print_table(e);
    print_profiles(o.device, {device});
}

} // namespace

void add_eval_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("eval", "Measure models and classical denoisers on a folder of test pairs");
    auto o = std::make_shared<EvalOptions>();
    c->add_option("DIR", o->folder, "Folder that `clvr pairs --split test` made")->type_name("DIR")->required();
    c->add_option("--report", o->report, "Also write one self-contained page with pictures, crops and curves")
        ->type_name("FILE.html")
        ->group("Output");
    c->add_flag("--json", o->json, "Print JSON with the measures of every view")->group("Output");
    c->add_option("--exposure", o->tonemap.exposure, "Report: exposure in stops [0]")->group("Output");
    c->add_option("--tonemap", o->tonemap.curve, "Report: tone curve [filmic]")->type_name("filmic|aces|reinhard|none")->group("Output");
    c->add_option("--model", o->models, "Trained network (.safetensors; may be given again) [the one inside clvr]")
        ->type_name("FILE")
        ->group("Measuring");
    c->add_option("--frame", o->frame, "Which noisy frame of each view, from 0 on, where there are several [0]")->group("Measuring");
    c->add_option("--tune", o->tune, "Choose the classical denoisers' settings on this folder of training pairs [defaults]")
        ->type_name("DIR")
        ->group("Measuring");
    c->footer("Examples:\n"
              "  clvr eval test --model mine.safetensors --report report.html\n"
              "  clvr eval test --model a.safetensors --model b.safetensors --tune train --json\n");
    add_device_options(*c, o->device, "denoise");
    reads_files(*c, {"DIR", "--model", "--tune"});
    writes_files(*c, "--report");
    c->callback([o] { eval(*o); });
}

} // namespace clvr
