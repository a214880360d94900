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
        choice.wants_samples |= missing == std::vector<std::string>{"noise"};
    }
    if (candidates.empty()) throw Error(ErrorKind::usage, "there is no model inside this build: add --model FILE");
    ChannelPlan(candidates.back().second, false).check(frame);
    return choice;
}

MadeChannels add_opacity(Frame& frame, const Model& model) {
    const std::vector<std::string> missing = ChannelPlan(model, false).missing(frame);
    if (std::find(missing.begin(), missing.end(), channel::opacity) == missing.end()) return {};
    const bool alpha = frame.has(channel::alpha);
    std::vector<float> opacity = alpha ? frame.at(channel::alpha) : std::vector<float>(frame.pixels(), 1.0f);
    frame.channels[channel::opacity] = std::move(opacity);
    return {{channel::opacity}, alpha ? "opacity.A is taken from A" : "opacity.A is taken as 1: there is no A"};
}

MadeChannels add_normal(Frame& frame) {
    const auto all = [&](const std::vector<std::string>& names, bool there) {
        return std::all_of(names.begin(), names.end(), [&](const auto& name) { return frame.has(name) == there; });
    };
    const std::vector<std::string> albedos(channel::albedo.begin(), channel::albedo.end()),
        normals(channel::normal.begin(), channel::normal.end());
    if (!all(albedos, true) || !all(normals, false)) return {};
    for (const auto& name : normals) frame.channel(name);
    return {normals, "normal is taken as 0, no surface: there is none"};
}

} // namespace clvr
