// Training of a model over folders of pairs.
#pragma once
#include "host/train/training_step.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// The reference protocol as defaults.
struct TrainerConfig {
    StepConfig step;
    int epochs = 200;
    std::int64_t steps = 0;     ///< ends after so many steps, if need be within an epoch; 0: after the last epoch
    int patches_per_image = 50; ///< drawn anew each epoch from each view
    double learning_rate = 1e-4;
    bool cosine = false; ///< the learning rate falls to 0 along half a cosine; else it is constant
    bool augment = true; ///< the 8 dihedral transforms
    std::uint64_t seed = 0;
};

/// What is known after an epoch.
struct EpochRecord {
    double loss = 0;       ///< mean of its steps
    double validation = 0; ///< mean PSNR of the validation frames [dB]; 0 without
};

struct TrainerProgress {
    double done = 0; ///< of all epochs, 0..1
    int epoch = 0;   ///< counted from 1
    double loss = 0; ///< of the last steps
    double validation = 0;
};

/// Trains and keeps everything on disk: `output` holds the best model (by validation; without it the last), <output>.last the last one,
/// <output>.checkpoint the state after each epoch (weights, moments, position, records, configuration), training_csv(output) a line for
/// each epoch. The state depends on the seed alone: the same bits whether or not the training was interrupted.
class Trainer {
public:
    /// Reads the frames. Several devices give the same files as one, also when the devices differ from those before `resume`. `resume`
    /// continues from the checkpoint, which must have the same configuration and data. Throws Error{input, memory}.
    Trainer(const std::vector<Device>& devices, const Model& model, const TrainerConfig& config, const std::vector<std::string>& folders,
            const std::string& validation_folder, const std::string& output, bool resume);
    Trainer(const Device& device, const Model& model, const TrainerConfig& config, const std::vector<std::string>& folders,
            const std::string& validation_folder, const std::string& output, bool resume)
        : Trainer(std::vector<Device>{device}, model, config, folders, validation_folder, output, resume) {}
    ~Trainer();

    /// Trains to the end, or until `cancelled`: then finishes the step and saves. Returns whether it reached the end. Throws
    /// Error{internal} when the loss becomes NaN, naming the step; the last checkpoint stays.
    bool run(const std::atomic<bool>& cancelled, const std::function<void(const TrainerProgress&)>& progress);

    const std::vector<EpochRecord>& records() const;
    /// The devices that have not failed.
    std::vector<Device> devices() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Where the training of a model file leaves its curve: <output>.training.csv (epoch, loss, validation_psnr).
std::string training_csv(const std::string& output);
/// All files that the training of a model file writes, itself first.
std::vector<std::string> training_files(const std::string& output);

/// The crops of an epoch in the order of its steps: `patches` of each view, of one of its `frames` images (view * frames + frame),
/// shuffled. A function of its arguments alone. `width`, `height` per view.
std::vector<Crop> epoch_crops(std::uint64_t seed, int epoch, const std::vector<std::pair<int, int>>& sizes, int frames, int patches,
                              int patch, bool augment);

} // namespace clvr
