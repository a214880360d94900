#include "host/experiment/experiment_estimate.hpp"
#include "host/eval/evaluation.hpp"
#include "host/experiment/measurement.hpp"
#include "host/io/scene/scene_inputs.hpp"
#include "host/io/volume/volume_file.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <chrono>

namespace clvr {

namespace {

constexpr int probe_views = 3, probe_spp = 8; // of the training views; samples beyond the first
constexpr int settings_tried = 18;            ///< measurement.cpp: 3x3 settings of two denoisers

/// Seconds that f takes.
template <class F>
double seconds_of(F&& f) {
    const auto begin = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::size_t bytes_of(const Frame& frame) { return frame.channels.size() * sizeof(float) * frame.width * frame.height; }

/// What rendering takes for each frame and for each sample of each pixel in it.
struct RenderRates {
    double plain = 0, with_features = 0; ///< [s] per frame with 0 samples
    double sample = 0;                   ///< [s] per sample per pixel of a frame
    std::size_t reference_bytes = 0, noisy_bytes = 0;
    Frame noisy;
};

RenderRates probe_rendering(const ExperimentSettings& s, const std::vector<Device>& devices, const PreparedVolume& volume,
                            const ExperimentControl& control) {
    PairsPlan plan = pairs_plan(s, "train");
    settle(plan, volume);
    const EnvironmentTables environment = read_environment(s.scene);
    Scene scene = frame_scene(plan, 0, 1);
    RenderSession session(devices, volume, scene, environment);
    RenderControl until;
    until.cancelled = &control.interrupted;
    const auto render = [&](int view, int spp, bool features) {
        Scene at = frame_scene(plan, view, features ? 1 : 0);
        at.spp = spp;
        Frame frame;
        const double seconds = seconds_of([&] {
            session.set_view(at);
            frame = clvr::render(session, at, until);
        });
        if (control.interrupted) throw Error(ErrorKind::interrupted, "interrupted");
        return std::pair(seconds, frame);
    };
    render(0, 1, true); // compiles the kernels
    RenderRates rates;
    const int views = std::min(probe_views, s.train.views);
    double first = 0, more = 0, features = 0;
    for (int k = 0; k < views; ++k) { // spread over the views
        const int view = k * s.train.views / views;
        control.progress("probing", k / (2.0 * views), "rendering");
        first += render(view, 1, false).first;
        auto [seconds, reference] = render(view, 1 + probe_spp, false);
        more += seconds;
        rates.reference_bytes = bytes_of(reference);
        auto [with, noisy] = render(view, 1, true);
        features += with;
        rates.noisy = std::move(noisy);
    }
    rates.sample = std::max(0.0, more - first) / (views * probe_spp);
    rates.plain = std::max(0.0, first / views - rates.sample);
    rates.with_features = std::max(0.0, features / views - rates.sample);
    const std::size_t variances = 3 * sizeof(float) * rates.noisy.width * rates.noisy.height; // from 2 samples on
    rates.noisy_bytes = bytes_of(rates.noisy) + variances;
    return rates;
}

StageEstimate rendering(const ExperimentSettings& s, const SplitSettings& split, const std::string& name, const RenderRates& rates) {
    StageEstimate e;
    e.name = name;
    double noisy = 0; // samples of the noisy frames of a view
    for (const int spp : s.spp) noisy += spp;
    const auto frames = static_cast<double>(s.spp.size());
    e.paths = split.views * (noisy + split.reference_spp) * s.scene.width * s.scene.height;
    e.seconds = split.views * (rates.plain + frames * rates.with_features + (noisy + split.reference_spp) * rates.sample);
    e.disk_bytes = static_cast<std::size_t>(split.views) * (rates.reference_bytes + s.spp.size() * rates.noisy_bytes);
    return e;
}

/// Some steps over the crops of one frame; `device_bytes` gets what all frames would take.
StageEstimate probe_training(const ExperimentSettings& s, const Device& device, const Frame& noisy, std::size_t& device_bytes) {
    Model model = s.model;
    initialise(model, s.training.seed);
    TrainingStep step(device, model, s.training.step);
    const std::size_t before = device.used_bytes();
    step.add_image(noisy, noisy);
    const std::size_t image_bytes = device.used_bytes() - before;
    const auto crops =
        epoch_crops(s.training.seed, 0, {{noisy.width, noisy.height}}, 1, s.training.step.batch, s.training.step.patch, s.training.augment);
    const auto run = [&](int steps) {
        return seconds_of([&] {
            for (int k = 0; k < steps; ++k) step.step(crops, s.training.learning_rate);
            step.take_losses();
        });
    };
    run(1); // compiles the kernels
    const double first = run(1);
    const int steps = std::clamp(static_cast<int>(2 / first), 1, 20);
    StageEstimate e;
    e.name = "training";
    e.steps = training_steps(s);
    e.seconds = static_cast<double>(e.steps) * run(steps) / steps;
    const std::size_t images = static_cast<std::size_t>(s.train.views) * s.spp.size();
    device_bytes = std::min(device.used_bytes() + (images - 1) * image_bytes, device.used_bytes() + device.free_bytes());
    e.disk_bytes = 8 * model.parameters() * sizeof(float) + 65536; // model twice, checkpoint: moments, best; the curve
    return e;
}

StageEstimate probe_measuring(const ExperimentSettings& s, const Device& device, const Frame& noisy) {
    Model model = s.model;
    initialise(model, s.training.seed);
    const std::vector<Candidate> all = candidates(device, {{"model", model}}, {});
    double denoising = 0, comparing = 0, classical = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        all[k].denoise(noisy); // compiles
        Frame done;
        const double seconds = seconds_of([&] { done = all[k].denoise(noisy); });
        denoising += seconds;
        if (k >= 2) classical += (seconds + seconds_of([&] { psnr(done, noisy); })) / 2;
        comparing += seconds_of([&] { compare_frames(done, noisy); });
    }
    StageEstimate e;
    e.name = "measuring";
    e.seconds = static_cast<double>(s.spp.size()) *
                (settings_tried * std::min(tuning_views, s.train.views) * classical + s.test.views * (denoising + comparing));
    e.disk_bytes = std::size_t{24} * 5 * 4 * noisy.width * noisy.height; // the report's pictures: three views
    return e;
}

} // namespace

StageEstimate ExperimentEstimate::total() const {
    StageEstimate sum;
    sum.name = "total";
    for (const StageEstimate& e : stages) {
        sum.seconds += e.seconds, sum.disk_bytes += e.disk_bytes, sum.paths += e.paths;
        sum.steps += e.steps;
    }
    return sum;
}

ExperimentEstimate estimate_experiment(const ExperimentSettings& s, const std::string& folder, std::vector<Device> devices,
                                       const ExperimentControl& control) {
    validate(s);
    ExperimentEstimate e;
    e.probe_seconds = seconds_of([&] {
        RenderRates rates;
        std::size_t training_bytes = 0;
        {
            control.progress("probing", 0, "volume");
            std::optional<PreparedVolume> volume;
            StageEstimate making;
            making.name = "volume";
            making.seconds = seconds_of([&] {
                volume.emplace(s.computed.empty() ? read_volume(volume_path(s, folder), s.scene.reading)
                                                  : make_phantom(devices.front(), s.computed,
                                                                 {s.size.dims, s.size.type, s.volume_seed, &control.interrupted}));
            });
            e.dims = volume->voxels.dims;
            e.type = volume->voxels.type;
            e.volume_bytes = volume->voxels.bytes.size();
            if (!s.computed.empty()) making.disk_bytes = e.volume_bytes;
            e.stages.push_back(making);
            rates = probe_rendering(s, devices, *volume, control);
        }
        e.stages.push_back(rendering(s, s.train, "train views", rates));
        e.stages.push_back(rendering(s, s.test, "test views", rates));
        for (const Device& d : devices) e.device_bytes = std::max(e.device_bytes, d.peak_bytes());
        control.progress("probing", 0.6, "training");
        e.stages.push_back(probe_training(s, devices.front(), rates.noisy, training_bytes));
        e.device_bytes = std::max(e.device_bytes, training_bytes);
        control.progress("probing", 0.9, "measuring");
        e.stages.push_back(probe_measuring(s, devices.front(), rates.noisy));
    });
    return e;
}

} // namespace clvr
