// What an experiment is: all that decides its bits.
#pragma once
#include "host/denoise/model.hpp"
#include "host/pairs/plan.hpp"
#include "host/phantom/phantom.hpp"
#include "host/train/trainer.hpp"

#include <optional>
#include <string>
#include <vector>

namespace clvr {

struct SplitSettings {
    int views = 0, reference_spp = 0;
};

/// A volume, pairs of it, a training and a measurement.
struct ExperimentSettings {
    std::string name;                 ///< of the scene: "head", "beetle", "snake", ..., or a file's stem
    std::string scale;                ///< one of experiment_scales
    std::string computed;             ///< the volume as make_phantom names it; empty: scene.volume is a file
    PhantomSize size;                 ///< of the computed volume
    std::uint64_t volume_seed = 0;    ///< of the computed volume
    Scene scene;                      ///< what is seen and how; the path of its volume is relative to the folders of pairs
    std::vector<int> spp{1, 2, 4, 8}; ///< of each view's noisy frames
    SplitSettings train, test;
    TrainerConfig training;
    Model model; ///< channels and switches of the network, without tensors
};

/// "paper", "quick", "tiny".
const std::vector<std::string>& experiment_scales();

/// The scale's views, picture size, samples, protocol of training and clvr's own network; no scene. Throws Error{usage} for another name.
/// - paper: the published protocol (100 training and 50 test views, 50 patches of 256x256 of each view, batches of 128, 200 epochs, Adam at
///   1e-4), pictures of 512x512 so that such patches are a quarter of them, references of 1024 (training) and 4096 (test) samples: test
///   references are 500 times as many as the largest noisy input, so that their own noise lies 27 dB below its.
/// - quick: 24 + 8 views at 192x192, references of 256 and 1024, 3000 steps of 8 patches of 128x128, 1e-3 falling along a cosine.
/// - tiny: 6 + 3 views at 96x96, references of 64, 600 steps of 4 patches of 64x64.
ExperimentSettings scale_settings(const std::string& scale);

/// Voxels of a computed volume at a scale: paper takes all, quick half of them along each axis, tiny 96 along the longest axis.
Int3 scaled_dims(const Int3& full, const std::string& scale);

/// Throws Error{usage} naming the option: numbers out of range, patches larger than the pictures.
void validate(const ExperimentSettings& settings);

/// The text of experiment.json: the same settings have the same text.
std::string to_json(const ExperimentSettings& settings);

/// The pairs of a split, "train" or "test"; not settled.
PairsPlan pairs_plan(const ExperimentSettings& settings, const std::string& split);

/// Where the volume of an experiment in `folder` lies, as seen from the working directory.
std::string volume_path(const ExperimentSettings& settings, const std::string& folder);

/// Steps of the training in all.
std::int64_t training_steps(const ExperimentSettings& settings);

} // namespace clvr
