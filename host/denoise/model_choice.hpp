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
};

/// The first candidate whose channels the frame has. Throws Error{input} naming what the last one lacks when none suits.
ModelChoice choose_model(const std::vector<std::pair<std::string, Model>>& candidates, const Frame& frame);

/// Gives the frame the opacity.A that a model weighs by and other renderers' files lack: A, else 1 (there is no background to look
/// through). Returns a sentence, empty: nothing was needed.
std::string add_opacity(Frame& frame, const Model& model);

} // namespace clvr
