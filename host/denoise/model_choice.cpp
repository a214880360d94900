#include "host/denoise/model_choice.hpp"
#include "host/denoise/channels.hpp"
#include "runtime/error.hpp"

#include <algorithm>

namespace clvr {

ModelChoice choose_model(const std::vector<std::pair<std::string, Model>>& candidates, const Frame& frame) {
    ModelChoice choice;
    for (const auto& [name, model] : candidates) {
        const ChannelPlan plan(model, false);
        const std::vector<std::string> missing = plan.missing(frame);
        if (&name == &candidates.front().first) choice.missing = missing;
        if (missing.empty()) {
            choice.name = name, choice.model = model;
            return choice;
        }
    }
    if (candidates.empty()) throw Error(ErrorKind::usage, "there is no model inside this build: add --model FILE");
    ChannelPlan(candidates.back().second, false).check(frame);
    return choice;
}

std::string add_opacity(Frame& frame, const Model& model) {
    const std::vector<std::string> missing = ChannelPlan(model, false).missing(frame);
    if (std::find(missing.begin(), missing.end(), "opacity.A") == missing.end()) return "";
    const bool alpha = frame.has("A");
    std::vector<float> opacity = alpha ? frame.at("A") : std::vector<float>(frame.pixels(), 1.0f);
    frame.channels["opacity.A"] = std::move(opacity);
    return alpha ? "opacity.A is taken from A" : "opacity.A is taken as 1: there is no A";
}

} // namespace clvr
