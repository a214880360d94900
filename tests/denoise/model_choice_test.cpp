#include "host/denoise/channels.hpp"
#include "host/denoise/model_choice.hpp"
#include "runtime/error.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Frame frame_with(const std::vector<std::string>& names) {
    Frame frame;
    frame.width = 2, frame.height = 1;
    for (const auto& name : names) frame.channels[name] = {0.25f, 0.5f};
    return frame;
}

std::vector<std::pair<std::string, Model>> candidates() {
    Model all = default_settings(), guided = default_settings(), colour = default_settings();
    guided.channels = {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z"};
    colour.channels = {"R", "G", "B"};
    guided.opacity_weight = colour.opacity_weight = false;
    return {{"all", all}, {"guided", guided}, {"colour", colour}};
}

TEST(ModelChoiceTest, TakesTheFirstThatTheFrameSuits) {
    Frame frame = frame_with(default_settings().channels);
    frame.channels.erase("noise");
    ModelChoice choice = choose_model(candidates(), frame);
    EXPECT_EQ(choice.name, "guided");
    EXPECT_THAT(choice.missing, ElementsAre("noise"));
    frame.attributes["clvr.spp"] = "4";
    choice = choose_model(candidates(), frame);
    EXPECT_EQ(choice.name, "all");
    EXPECT_TRUE(choice.missing.empty());
    frame.channels.erase("depth.half");
    EXPECT_EQ(choose_model(candidates(), frame).name, "guided");
    frame.channels.erase("normal.X");
    choice = choose_model(candidates(), frame);
    EXPECT_EQ(choice.name, "colour");
    EXPECT_EQ(choice.model.channels.size(), 3u);
    frame.channels.erase("G");
    try {
        choose_model(candidates(), frame);
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("lacks channel G that the model reads"));
    }
}

TEST(ModelChoiceTest, OpacityIsAlphaElseOne) {
    Model model = default_settings();
    model.channels = {"R", "G", "B"};
    Frame frame = frame_with({"R", "G", "B", "A"});
    EXPECT_THAT(add_opacity(frame, model), HasSubstr("taken from A"));
    EXPECT_THAT(frame.at("opacity.A"), ElementsAre(0.25f, 0.5f));
    EXPECT_EQ(add_opacity(frame, model), "") << "it is there now";
    frame = frame_with({"R", "G", "B"});
    EXPECT_THAT(add_opacity(frame, model), HasSubstr("no A"));
    EXPECT_THAT(frame.at("opacity.A"), ElementsAre(1, 1));
    frame = frame_with({"R", "G", "B"});
    model.opacity_weight = false;
    EXPECT_EQ(add_opacity(frame, model), "");
    EXPECT_FALSE(frame.has("opacity.A"));
}

TEST(ModelChoiceTest, NamesAllThatIsMissing) {
    const Frame frame = frame_with({"R", "G", "B", "opacity.A"});
    Model model = default_settings();
    model.channels = {"R", "G", "B", "normal.X", "noise", "depth.Z"};
    try {
        ChannelPlan(model, false).check(frame);
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.what(),
                    HasSubstr("lacks channels normal.X depth.Z and the attribute clvr.spp (--spp gives it) that the model reads; it has"));
    }
}

} // namespace
} // namespace clvr
