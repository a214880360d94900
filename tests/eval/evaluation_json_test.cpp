#include "host/eval/evaluation_json.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace clvr {
namespace {

TEST(EvaluationJson, ReadsBackToTheSame) {
    Metrics one{31.25, 0.9, 0.85, 0.01, 0.2, 0.3, 0.04}, equal{HUGE_VAL, 1, 1, 0, 0, 0, 0};
    const Evaluation e{{"/some/where/view_0000_noisy_1.exr", "/some/where/view_0001_noisy_1.exr"},
                       {{"noisy", {one, equal}, mean_of({one, equal})}, {"clvr", {one, one}, one}}};
    const auto json = nlohmann::ordered_json::parse(to_json(e).dump());
    EXPECT_TRUE(json["views"][1]["noisy"]["psnr"].is_null());
    const Evaluation back = parse_evaluation(json, "moved");
    EXPECT_EQ(back.views, (std::vector<std::string>{"moved/view_0000_noisy_1.exr", "moved/view_0001_noisy_1.exr"}));
    ASSERT_EQ(back.scores.size(), 2u);
    EXPECT_EQ(back.scores[0].name, "noisy");
    for (std::size_t s = 0; s < 2; ++s) {
        for (std::size_t v = 0; v < 2; ++v) EXPECT_EQ(named(back.scores[s].views[v]), named(e.scores[s].views[v]));
        EXPECT_EQ(named(back.scores[s].mean), named(e.scores[s].mean));
    }
    EXPECT_EQ(back.scores[1].mean.psnr, 31.25);
    EXPECT_ANY_THROW(parse_evaluation(nlohmann::ordered_json{{"mean", {{"noisy", {}}}}}, ""));
}

TEST(EvaluationJson, KeepsTheSettingsOfTheClassicalDenoisers) {
    Baselines b;
    b.cross_bilateral = {6, 0.4};
    b.wavelet = {16, 0.1};
    const Baselines back = parse_baselines(nlohmann::ordered_json::parse(to_json(b).dump()));
    EXPECT_EQ(back.cross_bilateral.spatial, 6);
    EXPECT_EQ(back.cross_bilateral.feature, 0.4);
    EXPECT_EQ(back.wavelet.colour, 16);
    EXPECT_EQ(back.wavelet.feature, 0.1);
}

} // namespace
} // namespace clvr
