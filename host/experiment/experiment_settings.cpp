#include "host/experiment/experiment_settings.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace clvr {

using nlohmann::ordered_json;

const std::vector<std::string>& experiment_scales() {
    static const std::vector<std::string> names{"paper", "quick", "tiny"};
    return names;
}

ExperimentSettings scale_settings(const std::string& scale) {
    const auto& known = experiment_scales();
    if (std::find(known.begin(), known.end(), scale) == known.end())
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected {}", scale, fmt::join(known, ", ")), "--scale");
    ExperimentSettings s;
    s.scale = scale;
    s.model = default_settings();
    TrainerConfig& t = s.training; // its defaults are the published protocol
    if (scale == "paper") {
        s.scene.width = s.scene.height = 512;
        s.train = {100, 1024};
        s.test = {50, 4096};
        return s;
    }
    t.learning_rate = 1e-3;
    t.cosine = true;
    if (scale == "quick") {
        s.scene.width = s.scene.height = 192;
        s.train = {24, 256};
        s.test = {8, 1024};
        t.steps = 3000;
        t.step.batch = 8;
        t.step.patch = 128;
    } else {
        s.scene.width = s.scene.height = 96;
        s.train = {6, 64};
        s.test = {3, 64};
        t.steps = 600;
        t.step.batch = 4;
        t.step.patch = 64;
    }
    return s;
}

Int3 scaled_dims(const Int3& full, const std::string& scale) {
    if (scale == "paper") return full;
    const double share = scale == "quick" ? 0.5 : 96.0 / *std::max_element(full.begin(), full.end());
    Int3 dims = full;
    for (int& n : dims) n = std::clamp(static_cast<int>(std::lround(n * share)), 1, n);
    return dims;
}

void validate(const ExperimentSettings& s) {
    const auto check = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw Error(ErrorKind::usage, fmt::format("is {}; expected {} to {}", value, low, high), name);
    };
    check("--views", s.train.views, 1, 100000);
    check("--test-views", s.test.views, 1, 100000);
    check("--reference-spp", s.train.reference_spp, 1, largest_spp);
    check("--test-reference-spp", s.test.reference_spp, 1, largest_spp);
    check("--epochs", s.training.epochs, 1, 1e6);
    check("--steps", static_cast<double>(s.training.steps), 0, 1e9);
    check("--batch", s.training.step.batch, 1, 65536);
    check("--patch", s.training.step.patch, 1, 4096);
    check("--lr", s.training.learning_rate, 1e-12, 10);
    if (s.training.step.patch > std::min(s.scene.width, s.scene.height))
        throw Error(
            ErrorKind::usage,
            fmt::format("is {}; the views have {}x{} pixels, which is the most", s.training.step.patch, s.scene.width, s.scene.height),
            "--patch");
    validate(s.scene);
}

std::string to_json(const ExperimentSettings& s) {
    ordered_json volume{{"file", s.scene.volume}};
    if (!s.computed.empty())
        volume = {{"computed", s.computed}, {"dims", s.size.dims}, {"type", voxel_type_name(s.size.type)}, {"seed", s.volume_seed}};
    const auto split = [](const SplitSettings& of) { return ordered_json{{"views", of.views}, {"reference_spp", of.reference_spp}}; };
    const TrainerConfig& t = s.training;
    ordered_json training{{"batch", t.step.batch}, {"patch", t.step.patch}, {"patches_per_image", t.patches_per_image}};
    if (t.steps > 0)
        training["steps"] = t.steps;
    else
        training["epochs"] = t.epochs;
    training.update({{"learning_rate", t.learning_rate}, {"schedule", t.cosine ? "cosine" : "constant"}, {"seed", t.seed}});
    const ordered_json all{{format_key, "experiment/1"},
                           {"scene", s.name},
                           {"scale", s.scale},
                           {"volume", volume},
                           {"spp", s.spp},
                           {"train", split(s.train)},
                           {"test", split(s.test)},
                           {"training", training},
                           {"model", ordered_json::parse(model_settings_json(s.model))},
                           {"picture", ordered_json::parse(to_json(s.scene))}};
    return all.dump(1) + "\n";
}

PairsPlan pairs_plan(const ExperimentSettings& s, const std::string& split) {
    const SplitSettings& of = split == "test" ? s.test : s.train;
    PairsPlan p;
    p.split = split;
    p.spp = s.spp;
    p.reference_spp = of.reference_spp;
    p.noisy_frames = static_cast<int>(s.spp.size());
    p.seed = s.scene.seed;
    p.scenes = {s.scene};
    p.views = split_views(split, p.seed, of.views, 1, 1);
    return p;
}

std::string volume_path(const ExperimentSettings& s, const std::string& folder) {
    return (std::filesystem::path(folder) / "train" / s.scene.volume).lexically_normal().string();
}

std::int64_t training_steps(const ExperimentSettings& s) {
    const TrainerConfig& t = s.training;
    if (t.steps > 0) return t.steps;
    const std::int64_t patches = static_cast<std::int64_t>(s.train.views) * t.patches_per_image;
    return (patches + t.step.batch - 1) / t.step.batch * t.epochs;
}

} // namespace clvr
