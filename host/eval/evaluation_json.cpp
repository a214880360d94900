#include "host/eval/evaluation_json.hpp"

#include <cmath>
#include <filesystem>
#include <limits>

namespace clvr {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

ordered_json to_json(const Metrics& metrics) {
    ordered_json all;
    for (const auto& [name, value] : named(metrics)) {
        if (std::isfinite(value))
            all[name] = value;
        else
            all[name] = nullptr;
    }
    return all;
}

Metrics parse_metrics(const ordered_json& json) {
    Metrics m;
    for (const auto& [name, to] : {std::pair("psnr", &m.psnr),
                                   {"ssim", &m.ssim},
                                   {"ssim_opaque", &m.ssim_opaque},
                                   {"rmse", &m.rmse},
                                   {"smape", &m.smape},
                                   {"relmse", &m.relmse},
                                   {"flip", &m.flip}}) {
        const auto& value = json.at(name);
        *to = value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
    }
    return m;
}

ordered_json to_json(const Baselines& b) {
    return {{"cross-bilateral", {{"spatial", b.cross_bilateral.spatial}, {"feature", b.cross_bilateral.feature}}},
            {"wavelet", {{"colour", b.wavelet.colour}, {"feature", b.wavelet.feature}}}};
}

Baselines parse_baselines(const ordered_json& json) {
    const auto &bilateral = json.at("cross-bilateral"), &wavelet = json.at("wavelet");
    return {{bilateral.at("spatial").get<double>(), bilateral.at("feature").get<double>()},
            {wavelet.at("colour").get<double>(), wavelet.at("feature").get<double>()}};
}

ordered_json to_json(const Evaluation& e) {
    ordered_json mean, views = ordered_json::array();
    for (const Score& s : e.scores) mean[s.name] = to_json(s.mean);
    for (std::size_t v = 0; v < e.views.size(); ++v) {
        ordered_json row{{"frame", fs::path(e.views[v]).filename().string()}};
        for (const Score& s : e.scores) row[s.name] = to_json(s.views[v]);
        views.push_back(row);
    }
    return {{"mean", mean}, {"views", views}};
}

Evaluation parse_evaluation(const ordered_json& json, const std::string& folder) {
    Evaluation e;
    for (const auto& [name, mean] : json.at("mean").items()) e.scores.push_back({name, {}, {}});
    for (const auto& row : json.at("views")) {
        e.views.push_back((fs::path(folder) / row.at("frame").get<std::string>()).string());
        for (Score& s : e.scores) s.views.push_back(parse_metrics(row.at(s.name)));
    }
    for (Score& s : e.scores) s.mean = mean_of(s.views);
    return e;
}

} // namespace clvr
