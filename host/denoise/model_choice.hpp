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

/// Gives the frame the opacity.A that a model weighs by and other renderers' files lack: A, else 1 (there is no background to look
/// through).
MadeChannels add_opacity(Frame& frame, const Model& model);

/// Gives a frame that has an albedo and no normal the normal 0, which in clvr's frames means that there is no surface: with it the albedo
/// alone helps (datasets/results/small_models.md). An albedo of 1 beside normals would not.
MadeChannels add_normal(Frame& frame);

} // namespace clvr
