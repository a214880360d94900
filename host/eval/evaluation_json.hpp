// Evaluations as JSON.
#pragma once
#include "host/eval/evaluation.hpp"

#include <nlohmann/json.hpp>

namespace clvr {

/// Measures by their names; what is infinite (the PSNR of equal pictures) is null.
nlohmann::ordered_json to_json(const Metrics& metrics);
nlohmann::ordered_json to_json(const Baselines& baselines);
/// {"mean": {candidate: measures}, "views": [{"frame": file, candidate: measures}]}: everything but folders.
nlohmann::ordered_json to_json(const Evaluation& evaluation);

/// Back from to_json; `folder` is where the frames lie. Throw nlohmann::json::exception.
Metrics parse_metrics(const nlohmann::ordered_json& json);
Baselines parse_baselines(const nlohmann::ordered_json& json);
Evaluation parse_evaluation(const nlohmann::ordered_json& json, const std::string& folder);

} // namespace clvr
