#include "host/experiment/experiment_settings.hpp"
#include "runtime/error.hpp"

#include <gmock/gmock.h>

#include <functional>

namespace clvr {
namespace {

TEST(ExperimentScales, PaperIsThePublishedProtocol) {
    const ExperimentSettings s = scale_settings("paper");
    EXPECT_EQ(s.train.views, 100);
    EXPECT_EQ(s.test.views, 50);
    EXPECT_EQ(s.training.patches_per_image, 50);
    EXPECT_EQ(s.training.step.patch, 256);
    EXPECT_EQ(s.training.step.batch, 128);
    EXPECT_EQ(s.training.epochs, 200);
    EXPECT_EQ(s.training.learning_rate, 1e-4);
    EXPECT_FALSE(s.training.cosine);
    EXPECT_EQ(training_steps(s), 200 * 40); // 5000 patches an epoch, the last batch not full
    EXPECT_EQ(s.spp, (std::vector<int>{1, 2, 4, 8}));
    EXPECT_EQ(scaled_dims({1024, 1024, 795}, "paper"), (Int3{1024, 1024, 795}));
}

TEST(ExperimentScales, SmallerOnesAreStatedFractions) {
    const ExperimentSettings quick = scale_settings("quick"), tiny = scale_settings("tiny");
    EXPECT_EQ(std::tuple(quick.train.views, quick.test.views, quick.scene.width, quick.scene.height), std::tuple(24, 8, 192, 192));
    EXPECT_EQ(std::pair(quick.train.reference_spp, quick.test.reference_spp), std::pair(256, 1024));
    EXPECT_EQ(std::tuple(training_steps(quick), quick.training.step.batch, quick.training.step.patch), std::tuple(3000, 8, 128));
    EXPECT_EQ(std::tuple(tiny.train.views, tiny.test.views, tiny.scene.width), std::tuple(6, 3, 96));
    EXPECT_EQ(std::pair(tiny.train.reference_spp, tiny.test.reference_spp), std::pair(64, 64));
    EXPECT_EQ(scaled_dims({512, 512, 294}, "quick"), (Int3{256, 256, 147}));
    EXPECT_EQ(scaled_dims({1024, 1024, 795}, "tiny"), (Int3{96, 96, 75}));
    EXPECT_EQ(scaled_dims({64, 64, 2}, "tiny"), (Int3{64, 64, 2})); // never more than there are
}

TEST(ExperimentSettings, RefusesWhatCannotBe) {
    EXPECT_THROW(scale_settings("huge"), Error);
    const std::pair<const char*, std::function<void(ExperimentSettings&)>> wrong[] = {
        {"--views", [](auto& s) { s.train.views = 0; }},
        {"--test-views", [](auto& s) { s.test.views = 0; }},
        {"--reference-spp", [](auto& s) { s.train.reference_spp = 0; }},
        {"--test-reference-spp", [](auto& s) { s.test.reference_spp = -1; }},
        {"--patch", [](auto& s) { s.training.step.patch = 97; }}, // pictures of 96x96
        {"--batch", [](auto& s) { s.training.step.batch = 0; }},
        {"--steps", [](auto& s) { s.training.steps = -1; }},
        {"--lr", [](auto& s) { s.training.learning_rate = 0; }}};
    for (const auto& [option, change] : wrong) {
        ExperimentSettings s = scale_settings("tiny");
        s.scene.volume = "../volume.nii";
        EXPECT_NO_THROW(validate(s));
        change(s);
        try {
            validate(s);
            ADD_FAILURE() << option;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::usage);
            EXPECT_EQ(e.where(), option);
        }
    }
}

TEST(ExperimentSettings, TextTellsExperimentsApart) {
    ExperimentSettings s = scale_settings("tiny");
    s.name = s.computed = "foam";
    s.scene.volume = "../volume.nii";
    const std::string text = to_json(s);
    EXPECT_EQ(to_json(s), text);
    const std::function<void(ExperimentSettings&)> changes[] = {[](auto& o) { o.volume_seed = 1; },
                                                                [](auto& o) { o.size.dims[2] = 5; },
                                                                [](auto& o) { o.scene.seed = 1; },
                                                                [](auto& o) { o.scene.width = 97; },
                                                                [](auto& o) {
                                                                    o.spp = {1, 2};
                                                                },
                                                                [](auto& o) { o.train.views = 7; },
                                                                [](auto& o) { o.test.reference_spp = 65; },
                                                                [](auto& o) { o.training.steps = 601; },
                                                                [](auto& o) { o.training.step.batch = 5; },
                                                                [](auto& o) { o.training.learning_rate = 1e-4; },
                                                                [](auto& o) { o.training.cosine = false; },
                                                                [](auto& o) { o.model.opacity_weight = !o.model.opacity_weight; },
                                                                [](auto& o) { o.model.channels.pop_back(); }};
    for (std::size_t k = 0; k < std::size(changes); ++k) {
        ExperimentSettings other = s;
        changes[k](other);
        EXPECT_NE(to_json(other), text) << k;
    }
}

TEST(ExperimentSettings, PairsOfTheSplitsHaveOtherViewsAndNoise) {
    ExperimentSettings s = scale_settings("tiny");
    s.test.views = s.train.views;
    const PairsPlan train = pairs_plan(s, "train"), test = pairs_plan(s, "test");
    EXPECT_EQ(train.noisy_frames, 4);
    EXPECT_EQ(train.views.size(), 6u);
    EXPECT_NE(train.views[0].azimuth, test.views[0].azimuth);
    std::set<std::uint64_t> seeds;
    for (const PairsPlan* plan : {&train, &test})
        for (int role = 0; role <= 4; ++role) seeds.insert(frame_scene(*plan, 2, role).seed);
    EXPECT_EQ(seeds.size(), 10u);
    EXPECT_EQ(frame_scene(train, 2, 0).spp, 64);
    EXPECT_FALSE(frame_scene(train, 2, 0).features);
    EXPECT_EQ(frame_scene(train, 2, 4).spp, 8);
    EXPECT_TRUE(frame_scene(train, 2, 4).features);
    EXPECT_EQ(frame_scene(train, 2, 1).view, 2);
}

TEST(ExperimentSettings, VolumesLieInOrBesideTheFolder) {
    ExperimentSettings s;
    s.scene.volume = "../volume.nii";
    EXPECT_EQ(volume_path(s, "some/folder"), "some/folder/volume.nii");
    EXPECT_EQ(volume_path(s, "."), "volume.nii");
    s.scene.volume = "/data/scan.nii.gz";
    EXPECT_EQ(volume_path(s, "some/folder"), "/data/scan.nii.gz");
}

} // namespace
} // namespace clvr
