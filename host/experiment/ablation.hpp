// What each input channel and switch of the network brings: the same training with fewer or other ones.
#pragma once
#include "host/experiment/experiment.hpp"
#include "host/frame/metrics.hpp"

#include <string>
#include <vector>

namespace clvr {

/// A variant of the network.
struct AblationRow {
    std::string name;  ///< of its files
    std::string title; ///< in tables
    bool standard;     ///< among the eight that run unless others are asked for
    Model model;       ///< channels and switches, without tensors
};

/// Rows 1 to 5 add up: colour, albedo, normal, depth, then opacity, depth deviation and half depth, which make the full set. Rows 6 to 8
/// change one thing of the full set: no demodulation by the albedo, pixels weighted by opacity in the splat, the noise level as a channel.
/// Further rows run on demand only: opacity weights and noise level together; that with the known light (KnownLight) as channels; and that
/// with the known light also subtracted. All have the exposure and the albedo floor of clvr's default.
const std::vector<AblationRow>& ablation_rows();

struct AblationSettings {
    std::vector<std::string> train, test; ///< folders of pairs
    std::vector<int> spp{1, 4};           ///< of the noisy frames that are measured
    std::vector<std::string> rows;        ///< names; empty: the eight
    TrainerConfig training;               ///< the same for all rows
};

/// 1500 steps of 8 patches of 128x128, 1e-3 falling along a cosine.
TrainerConfig ablation_training();

/// Mean of the views of a test folder at some samples per pixel.
struct AblationScore {
    std::string test; ///< the folder's name
    int spp = 0;
    Metrics mean;
};

/// A row with its scores: the tests at the first samples per pixel, then at the next.
struct AblationResult {
    std::string title;
    std::vector<AblationScore> scores;
    double seconds_per_step = 0; ///< 0: not trained (the noisy input)
};

/// Markdown: the rows' means over the tests at each number of samples per pixel, then PSNR / SSIM of each test.
std::string markdown_tables(const std::vector<AblationResult>& results);

/// Measures the noisy input, then trains and measures each row. A row is kept in the folder as NAME.safetensors (with what `clvr train`
/// leaves beside it) and NAME.json, and is not done again. settings.json has what all rows share, ablation.json and ablation.md the table.
/// The models have the same bits however often this was interrupted. Throws Error{usage}: an unknown row, patches larger than the pictures;
/// Error{input}: folders that are missing or not complete, that lack such noisy frames or references, or that belong to another ablation;
/// Error{interrupted}.
std::vector<AblationResult> run_ablation(const AblationSettings& settings, const std::string& folder, const Device& device,
                                         const Provenance& provenance, const ExperimentControl& control);

/// The files that an ablation writes in its folder.
std::vector<std::string> ablation_files(const std::string& folder);

} // namespace clvr
