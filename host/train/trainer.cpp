#include "host/train/trainer.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/frame/metrics.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/pairs/folder.hpp"
#include "host/train/checkpoint.hpp"
#include "runtime/error.hpp"
#include "runtime/schedule/scheduler.hpp"
#include "runtime/system/atomic_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {

namespace {

/// A view's frames with their targets: the reference, or the next noisy frame.
struct View {
    std::vector<Frame> noisy;
    Frame reference;

    const Frame& target(std::size_t k, bool noisy_target) const { return noisy_target ? noisy[(k + 1) % noisy.size()] : reference; }
};

View read_view(const PairView& files, bool noisy_target) {
    View view;
    if (noisy_target && files.noisy.size() < 2)
        throw Error(ErrorKind::input, "is the only noisy frame of its view; --target noisy needs two (clvr pairs --noisy-frames 2)",
                    files.noisy.front());
    if (!noisy_target && files.reference.empty())
        throw Error(ErrorKind::input, "has no reference; train with --target noisy", files.noisy.front());
    for (const auto& path : files.noisy) view.noisy.push_back(read_exr(path));
    if (!noisy_target) view.reference = read_exr(files.reference);
    return view;
}

/// A path without its ending.
std::string stem_of(const std::string& path) { return std::filesystem::path(path).replace_extension().string(); }

std::string configuration_of(const Model& model, const TrainerConfig& c, const std::vector<std::string>& views) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const auto& l : model.levels) levels.push_back({l.pixels, l.codes});
    nlohmann::ordered_json all{{"loss", static_cast<int>(c.step.loss)},
                               {"convolution", c.step.convolution == ConvolutionBackend::clblast ? "clblast" : "direct"},
                               {"patch", c.step.patch},
                               {"batch", c.step.batch},
                               {"epochs", c.epochs},
                               {"patches_per_image", c.patches_per_image},
                               {"learning_rate", c.learning_rate},
                               {"schedule", c.cosine ? "cosine" : "constant"},
                               {"augment", c.augment},
                               {"betas", {c.step.beta1, c.step.beta2}},
                               {"clip_norm", c.step.clip_norm},
                               {"seed", c.seed},
                               {"channels", model.channels},
                               {"hidden", model.hidden},
                               {"kernel", model.kernel},
                               {"levels", levels},
                               {"exposure", model.exposure},
                               {"opacity_weight", model.opacity_weight},
                               {"albedo_floor", static_cast<double>(model.albedo_floor)},
                               {"views", views}};
    // Only where they differ from the default, so that checkpoints made before these settings still match.
    if (c.steps > 0) all["steps"] = c.steps;
    if (!model.demodulation) all["demodulation"] = false;
    if (model.control_variate) all["control_variate"] = true;
    if (model.control_variate_cell) all["control_variate_cell"] = model.control_variate_cell;
    return all.dump();
}

std::string checkpoint_of(const std::string& output) { return stem_of(output) + ".checkpoint"; }

} // namespace

std::string training_csv(const std::string& output) { return stem_of(output) + ".training.csv"; }

std::vector<std::string> training_files(const std::string& output) {
    return {output, training_csv(output), stem_of(output) + ".last.safetensors", checkpoint_of(output)};
}

struct Trainer::State {
    std::vector<Device> validators; // the first one that can validates
    TrainerConfig config;
    std::string output;
    TrainingStep step;
    std::vector<std::pair<int, int>> sizes; // of the views
    int frames = 1;                         // noisy ones of each view
    std::vector<std::pair<Frame, Frame>> validation;
    Checkpoint checkpoint;

    State(const std::vector<Device>& d, const Model& m, const TrainerConfig& c, const std::string& out)
        : validators(d), config(c), output(out), step(d, m, c.step) {
        checkpoint.best = m;
    }

    int steps_per_epoch() const {
        const int patches = static_cast<int>(sizes.size()) * config.patches_per_image;
        return (patches + config.step.batch - 1) / config.step.batch;
    }

    std::int64_t total_steps() const {
        return config.steps > 0 ? config.steps : static_cast<std::int64_t>(steps_per_epoch()) * config.epochs;
    }

    double learning_rate(std::int64_t at) const {
        if (!config.cosine) return config.learning_rate;
        const double total = static_cast<double>(total_steps());
        return config.learning_rate * 0.5 * (1 + std::cos(3.14159265358979323846 * static_cast<double>(at) / total));
    }

    double validate_model() {
        if (validation.empty()) return 0;
        std::vector<Device> left = step.devices();
        const auto failed = [&](Device& d) { return std::none_of(left.begin(), left.end(), [&](Device& l) { return is_same(l, d); }); };
        validators.erase(std::remove_if(validators.begin(), validators.end(), failed), validators.end());
        if (validators.empty()) validators = left;
        return on_first(validators, [&](Device& device) {
            Denoiser denoiser(device, step.model());
            double sum = 0;
            for (const auto& [noisy, reference] : validation) sum += psnr(denoiser.denoise(noisy), reference);
            return sum / static_cast<double>(validation.size());
        });
    }

    /// Writes every file, each as a whole; the checkpoint last, so that it never promises what the others lack.
    void save() {
        checkpoint.state = step.state();
        std::string csv = "epoch,loss,validation_psnr\n";
        for (std::size_t e = 0; e < checkpoint.records.size(); ++e)
            csv += fmt::format("{},{},{}\n", e + 1, checkpoint.records[e].loss, checkpoint.records[e].validation);
        const std::string stem = stem_of(output);
        write_atomically(training_csv(output), csv);
        const auto noted = [&](Model m) {
            m.notes["clvr.training"] = checkpoint.configuration;
            return m;
        };
        write_model(noted(step.model()), stem + ".last.safetensors");
        write_model(noted(validation.empty() ? step.model() : checkpoint.best), output);
        write_checkpoint(checkpoint, step.model(), checkpoint_of(output));
    }

    /// Adds the losses of the steps since the last call. Returns the first step whose loss or weights are not finite, or -1.
    std::int64_t collect(std::int64_t first_step, double& recent) {
        const std::vector<double> losses = step.take_losses();
        for (std::size_t k = 0; k < losses.size(); ++k) {
            if (!std::isfinite(losses[k])) return first_step + static_cast<std::int64_t>(k) + 1;
            checkpoint.loss_sum += losses[k];
            recent = losses[k];
        }
        // Where kernels clamp, they turn NaN into numbers, so a loss can look sound though the weights are lost.
        const std::vector<float> weights = step.state().parameters;
        const bool lost = std::any_of(weights.begin(), weights.end(), [](float w) { return !std::isfinite(w); });
        return lost ? first_step + static_cast<std::int64_t>(losses.size()) : -1;
    }
};

Trainer::Trainer(const std::vector<Device>& devices, const Model& model, const TrainerConfig& config,
                 const std::vector<std::string>& folders, const std::string& validation_folder, const std::string& output, bool resume)
    : state_(std::make_unique<State>(devices, model, config, output)) {
    State& s = *state_;
    const bool noisy_target = config.step.loss == Loss::noisy;
    std::vector<std::string> names;
    bool first = true;
    for (const auto& folder : folders)
        for (const auto& files : read_pairs(folder).views) {
            const View view = read_view(files, noisy_target);
            if (!first && static_cast<int>(view.noisy.size()) != s.frames)
                throw Error(ErrorKind::input, fmt::format("has {} noisy frames a view, other folders {}", view.noisy.size(), s.frames),
                            folder);
            s.frames = static_cast<int>(view.noisy.size());
            first = false;
            for (std::size_t k = 0; k < view.noisy.size(); ++k) {
                try {
                    s.step.add_image(view.noisy[k], view.target(k, noisy_target));
                } catch (const Error& e) {
                    throw Error(e.kind(), e.what(), files.noisy[k]);
                }
            }
            s.sizes.emplace_back(view.noisy.front().width, view.noisy.front().height);
            names.push_back(pixel_hash(view.noisy.front()).substr(0, 16));
        }
    if (s.sizes.empty()) throw Error(ErrorKind::input, "no training views given", "clvr train");
    if (!validation_folder.empty())
        for (const auto& files : read_pairs(validation_folder).views) {
            if (files.reference.empty()) throw Error(ErrorKind::input, "has no references to validate against", validation_folder);
            s.validation.emplace_back(read_exr(files.noisy.front()), read_exr(files.reference));
        }
    s.checkpoint.configuration = configuration_of(model, config, names);
    if (resume) {
        s.checkpoint = read_checkpoint(checkpoint_of(output), s.checkpoint.configuration);
        s.step.set_state(s.checkpoint.state);
    }
}
Trainer::~Trainer() = default;

const std::vector<EpochRecord>& Trainer::records() const { return state_->checkpoint.records; }

std::vector<Device> Trainer::devices() const { return state_->step.devices(); }

bool Trainer::run(const std::atomic<bool>& cancelled, const std::function<void(const TrainerProgress&)>& progress) {
    State& s = *state_;
    const TrainerConfig& c = s.config;
    const std::int64_t per_epoch = s.steps_per_epoch(), total = s.total_steps();
    std::int64_t at = s.step.state().step, collected = at;
    TrainerProgress p;
    if (at >= total) s.save(); // finished before: writes the files again, as some may have been removed
    for (int epoch = static_cast<int>(at / per_epoch); at < total; ++epoch) {
        const std::vector<Crop> crops = epoch_crops(c.seed, epoch, s.sizes, s.frames, c.patches_per_image, c.step.patch, c.augment);
        const std::int64_t count = std::min(per_epoch, total - epoch * per_epoch);
        for (std::int64_t k = at % per_epoch; k < count; ++k) {
            const auto from = crops.begin() + static_cast<std::ptrdiff_t>(k * c.step.batch);
            const auto to = std::min(crops.end(), from + c.step.batch);
            s.step.step({from, to}, s.learning_rate(at));
            ++at;
            const bool last = k + 1 == count;
            if (last || cancelled || at % 16 == 0) {
                const std::int64_t nan = s.collect(collected, p.loss);
                if (nan >= 0)
                    throw Error(
                        ErrorKind::internal,
                        fmt::format("the loss became NaN at step {}; the checkpoint of epoch {} is kept. Try a lower --lr or --clip-norm 1",
                                    nan, s.checkpoint.records.size()));
                collected = at;
                p.done = static_cast<double>(at) / static_cast<double>(total);
                p.epoch = epoch + 1;
                progress(p);
            }
            if (cancelled && !last) {
                s.save();
                return false;
            }
        }
        EpochRecord record{s.checkpoint.loss_sum / static_cast<double>(count), s.validate_model()};
        s.checkpoint.loss_sum = 0;
        if (s.checkpoint.records.empty() || record.validation > s.checkpoint.best_validation) {
            s.checkpoint.best = s.step.model();
            s.checkpoint.best_validation = record.validation;
        }
        p.validation = record.validation;
        s.checkpoint.records.push_back(record);
        s.save();
        progress(p);
        if (cancelled) return at == total;
    }
    return true;
}

} // namespace clvr
