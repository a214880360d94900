// Which of several models suits a frame.
#pragma once
#include "host/denoise/model.hpp"
#include "host/frame/frame.hpp"

#include <string>
#include <utility>
#include <vector>

namespace clvr {

struct ModelChoice {
    std::string name;
    Model model;
    std::vector<std::string> missing; ///< what the first candidate reads and the frame lacks; empty: it is chosen
    bool wants_samples = false;       ///< a candidate before the chosen one lacks the samples per pixel alone
};

/// The first candidate whose channels the frame has. Throws Error{input} naming what the last one lacks when none suits.
ModelChoice choose_model(const std::vector<std::pair<std::string, Model>>& candidates, const Frame& frame);

/// Channels made for a model, and what to say of it; empty: nothing was needed.
struct MadeChannels {
    std::vector<std::string> names;
    std::string said;
};

/// Where the model weighs pixels by opacity.A and the frame (of another renderer) has none, adds it: A, else 1, as there is no background
/// to look through.
MadeChannels add_opacity(Frame& frame, const Model& model);

/// Where the frame has an albedo but no normal, adds the normal 0, which in clvr's frames means "no surface": with it, the albedo alone
/// still helps (datasets/results/small_models.md). An albedo of 1 for a frame with normals does not help.
MadeChannels add_normal(Frame& frame);

} // namespace clvr
