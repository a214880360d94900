#include "host/experiment/experiment.hpp"
#include "host/eval/evaluation_json.hpp"
#include "host/experiment/measurement.hpp"
#include "host/experiment/stage_times.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/scene/scene_inputs.hpp"
#include "host/io/settled_folder.hpp"
#include "host/io/volume/dataset_path.hpp"
#include "host/io/volume/volume_file.hpp"
#include "host/pairs/rendering.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_text.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clvr {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

[[noreturn]] void interrupted_here() { throw Error(ErrorKind::interrupted, "interrupted; the same command goes on from here"); }

/// Makes the folder, or checks that it is this experiment's.
void begin_experiment_folder(const std::string& settings, const std::string& folder) {
    begin_settled_folder(folder, "experiment.json", settings,
                         "holds an experiment with other settings (its experiment.json has them); name another folder, or remove this one");
}

/// A folder with an experiment, and the stages that fill it.
class Run {
public:
    Run(const ExperimentSettings& settings, const std::string& folder, std::vector<Device>& devices, const Provenance& provenance,
        const ExperimentControl& control)
        : s_(settings), folder_(folder), devices_(devices), provenance_(provenance), control_(control), times_(path("stages.json")) {}

    ExperimentOutcome operator()() {
        ExperimentOutcome outcome;
        const bool measured = read_measurements(path("evaluation.json"), path("test")).size() == s_.spp.size();
        const bool trained = times_.finished("training") && fs::exists(path("model.safetensors"));
        const bool written = fs::exists(path("results.json")) && fs::exists(path("results.md")), shown = fs::exists(path("report.html"));
        outcome.changed = !(measured && trained && written && shown);
        if (!trained || !measured) render("train");
        if (!measured || !shown) render("test");
        volume_.reset();
        if (!trained) train();
        const Model model = read_model(path("model.safetensors"));
        if (!measured) measure_all(model);
        const std::vector<Measurement> measurements = read_measurements(path("evaluation.json"), path("test"));
        outcome.table = markdown_tables(measurements);
        if (!written || !measured || !trained) write_results(measurements, outcome.table);
        if (!shown || !measured || !trained) write_report(model, measurements);
        return outcome;
    }

private:
    const ExperimentSettings& s_;
    std::string folder_;
    std::vector<Device>& devices_;
    const Provenance& provenance_;
    const ExperimentControl& control_;
    StageTimes times_;
    std::optional<PreparedVolume> volume_; // while pairs are rendered

    std::string path(const std::string& name) const { return (fs::path(folder_) / name).string(); }

    void render(const std::string& split) {
        const std::string to = path(split), label = split + " views";
        if (pairs_complete(to)) return;
        if (!volume_)
            times_.time("volume", [&] {
                control_.progress("volume", 0, s_.name);
                volume_.emplace(experiment_volume(s_, folder_, devices_.front(), control_.interrupted));
            });
        const int done = times_.time(label, [&] {
            PairsPlan plan = pairs_plan(s_, split);
            settle(plan, *volume_);
            begin_pairs_folder(to, plan);
            const int views = static_cast<int>(plan.views.size());
            return render_pairs(devices_, *volume_, read_environment(s_.scene), plan, to, control_.interrupted, [&](int before) {
                control_.progress(label, static_cast<double>(before) / views, fmt::format("view {} of {}", before + 1, views));
            });
        });
        if (done < (split == "test" ? s_.test : s_.train).views) interrupted_here();
    }

    void train() {
        Model start = s_.model;
        initialise(start, s_.training.seed);
        const bool finished = times_.time("training", [&] {
            control_.progress("training", 0, "reading");
            Trainer trainer(devices_, start, s_.training, {path("train")}, "", path("model.safetensors"),
                            fs::exists(path("model.checkpoint")));
            return trainer.run(control_.interrupted, [&](const TrainerProgress& p) {
                control_.progress("training", p.done, fmt::format("loss {:.5f}", p.loss));
            });
        });
        if (!finished) interrupted_here();
        times_.finish("training");
    }

    void measure_all(const Model& model) {
        times_.time("measuring", [&] {
            measure(devices_.front(), model, path("train"), path("test"), s_.spp, path("evaluation.json"), control_.interrupted,
                    [&](double done, const std::string& note) { control_.progress("measuring", done, note); });
        });
    }

    void write_results(const std::vector<Measurement>& measurements, const std::string& table) const {
        std::vector<std::string> names;
        for (const Device& d : devices_)
            names.push_back(fmt::format("{} ({} {})", d.facts().name, d.facts().platform, d.facts().driver_version));
        ordered_json results{{format_key, "results/1"},
                             {"scene", s_.name},
                             {"scale", s_.scale},
                             {"device", fmt::format("{}", fmt::join(names, " + "))},
                             {"version", provenance_.version}};
        if (!provenance_.commit.empty()) results["commit"] = provenance_.commit;
        results["command"] = provenance_.command;
        results["settings"] = ordered_json::parse(read_text(path("experiment.json")));
        ordered_json seconds = ordered_json::object();
        for (const auto& [stage, s] : times_.all()) seconds[stage] = s;
        results["seconds"] = seconds;
        results["training_steps"] = training_steps(s_);
        results["seconds_per_step"] = times_.seconds("training") / static_cast<double>(training_steps(s_));
        ordered_json frames = ordered_json::array();
        for (const Measurement& m : measurements)
            frames.push_back({{"spp", m.spp}, {"baselines", to_json(m.baselines)}, {"mean", to_json(m.evaluation).at("mean")}});
        results["frames"] = frames;
        write_atomically(path("results.json"), json_text(results));

        const std::string volume =
            s_.computed.empty() ? "a file" : fmt::format("computed, {} {}", fmt::join(s_.size.dims, "x"), voxel_type_name(s_.size.type));
        write_atomically(
            path("results.md"),
            fmt::format("# {}, scale {}\n\nVolume: {}. {} training and {} test views of {}x{} pixels, references of {} and {} samples per "
                        "pixel. {} steps of {} patches of {}x{}. Means over the test views.\n\n{}\n`{}`, clvr {}{}, {}, {:.0f} s\n",
                        s_.name, s_.scale, volume, s_.train.views, s_.test.views, s_.scene.width, s_.scene.height, s_.train.reference_spp,
                        s_.test.reference_spp, training_steps(s_), s_.training.step.batch, s_.training.step.patch, s_.training.step.patch,
                        table, provenance_.command, provenance_.version, provenance_.commit.empty() ? "" : " at " + provenance_.commit,
                        fmt::join(names, " + "), total_seconds()));
    }

    double total_seconds() const {
        double sum = 0;
        for (const auto& [stage, seconds] : times_.all()) sum += seconds;
        return sum;
    }

    void write_report(const Model& model, const std::vector<Measurement>& measurements) {
        control_.progress("report", 0, "");
        ReportOptions r;
        r.title = fmt::format("clvr experiment {} --scale {}", s_.name, s_.scale);
        r.notes = {fmt::format("{} training views (references {} spp), {} test views (references {} spp), {}x{} pixels", s_.train.views,
                               s_.train.reference_spp, s_.test.views, s_.test.reference_spp, s_.scene.width, s_.scene.height),
                   fmt::format("{} steps of {} patches of {}x{}, one model for all samples per pixel", training_steps(s_),
                               s_.training.step.batch, s_.training.step.patch, s_.training.step.patch),
                   "classical denoisers: the best of 3x3 settings on training views, at each number of samples per pixel",
                   "PSNR and SSIM of clip(RGB, 0, 1)^(1/2.2) over black; RMSE, SMAPE and relMSE linear"};
        r.trainings = {{trained_candidate, read_text(training_csv(path("model.safetensors")))}};
        write_atomically(path("report.html"), html_report(report_parts(devices_.front(), model, measurements), path("test"), r));
    }
};

} // namespace

std::vector<std::string> experiment_files(const std::string& folder) {
    std::vector<std::string> files = training_files((fs::path(folder) / "model.safetensors").string());
    for (const char* name : {"experiment.json", "stages.json", "evaluation.json", "results.json", "results.md", "report.html"})
        files.push_back((fs::path(folder) / name).string());
    return files;
}

Voxels experiment_volume(const ExperimentSettings& s, const std::string& folder, Device& device, const std::atomic<bool>& interrupted) {
    const std::string path = volume_path(s, folder);
    if (s.computed.empty()) return read_volume(path, s.scene.reading);
    // Always read from the file, which rounds the geometry to floats, also when it was made just now.
    if (!fs::exists(path)) write_nifti(make_phantom(device, s.computed, {s.size.dims, s.size.type, s.volume_seed, &interrupted}), path);
    if (interrupted) interrupted_here();
    return read_volume(path);
}

ExperimentOutcome run_experiment(const ExperimentSettings& settings, const std::string& folder, std::vector<Device> devices,
                                 const Provenance& provenance, const ExperimentControl& control) {
    validate(settings);
    // Checked before anything is written. Once all pairs are there, the volume is not needed any more.
    if (settings.computed.empty() && !fs::exists(split_dataset_path(volume_path(settings, folder)).file) &&
        !fs::exists(fs::path(folder) / "experiment.json"))
        throw Error(ErrorKind::input, "there is no such file or folder", volume_path(settings, folder));
    begin_experiment_folder(to_json(settings), folder);
    return Run(settings, folder, devices, provenance, control)();
}

} // namespace clvr
