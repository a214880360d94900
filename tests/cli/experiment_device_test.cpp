// `clvr experiment` and `clvr ablation` as a user sees them, at their smallest.
#include "tests/cli/experiment_folder.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <csignal>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> smallest{"--scale",
                                        "tiny",
                                        "--dims",
                                        "20x24x18",
                                        "--size",
                                        "24x20",
                                        "--views",
                                        "3",
                                        "--test-views",
                                        "2",
                                        "--reference-spp",
                                        "4",
                                        "--test-reference-spp",
                                        "4",
                                        "--steps",
                                        "12",
                                        "--patch",
                                        "16",
                                        "--batch",
                                        "2"};

class Experiment : public ExperimentFolder {
protected:
    Outcome experiment(const std::string& to, const std::vector<std::string>& more = {}, const std::string& scene = "foam") const {
        std::vector<std::string> words{"experiment", scene, "-o", path(to)};
        words.insert(words.end(), smallest.begin(), smallest.end());
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
    void succeeds(const std::string& to) const {
        const Outcome o = experiment(to);
        ASSERT_EQ(o.exit_code, 0) << o.err;
    }
};

TEST_F(Experiment, RunsAndIsGoneOnWith) {
    const Outcome o = experiment("e");
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.out, AllOf(HasSubstr("PSNR [dB]"), HasSubstr("8 spp"), HasSubstr("cross-bilateral")));
    const auto results = nlohmann::json::parse(text("e/results.json"));
    EXPECT_EQ(results["scene"], "foam");
    EXPECT_EQ(results["scale"], "tiny");
    EXPECT_EQ(results["training_steps"], 12);
    EXPECT_GT(results["seconds_per_step"].get<double>(), 0);
    EXPECT_THAT(results["command"].get<std::string>(),
                AllOf(HasSubstr("clvr experiment foam"), HasSubstr("--dims 20x24x18"), Not(HasSubstr("-o"))));
    for (const char* key : {"device", "version", "seconds", "settings"}) EXPECT_TRUE(results.contains(key)) << key;
    ASSERT_EQ(results["frames"].size(), 4u);
    const auto evaluation = nlohmann::json::parse(text("e/evaluation.json"));
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(results["frames"][k]["spp"], 1 << k);
        for (const char* candidate : {"noisy", "clvr", "cross-bilateral", "wavelet"})
            EXPECT_EQ(results["frames"][k]["mean"][candidate], evaluation["frames"][k]["mean"][candidate]);
        EXPECT_EQ(evaluation["frames"][k]["views"].size(), 2u);
    }
    // Each view's frames have the samples that they claim.
    EXPECT_EQ(nlohmann::json::parse(text("e/train/pairs.json"))["spp"], nlohmann::json({1, 2, 4, 8}));

    const auto before = contents("e");
    const Outcome again = experiment("e");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_THAT(again.err, HasSubstr("nothing was left to do"));
    EXPECT_EQ(again.out, o.out);
    EXPECT_EQ(contents("e"), before);

    // Whatever is lost is made again with the same bits, and nothing else. What says how long it took is not.
    std::filesystem::remove(folder.path() / "e/report.html");
    ASSERT_NO_FATAL_FAILURE(succeeds("e"));
    EXPECT_EQ(contents("e"), before);
    for (const char* lost : {"test/view_0001_noisy_2.exr", "evaluation.json", "model.safetensors"})
        std::filesystem::remove(folder.path() / "e" / lost);
    ASSERT_NO_FATAL_FAILURE(succeeds("e"));
    EXPECT_EQ(untimed(contents("e")), untimed(before));

    const Outcome other = experiment("e", {"--seed", "1"});
    EXPECT_EQ(other.exit_code, 3);
    EXPECT_THAT(other.err, HasSubstr("other settings"));
    // Elsewhere, interrupted as the files of each stage appear: the same bits.
    for (const char* reached : {"", "train/pairs.json", "test/pairs.json", "model.checkpoint", "model.safetensors"}) {
        std::vector<std::string> words{"experiment", "foam", "-o", path("i")};
        words.insert(words.end(), smallest.begin(), smallest.end());
        Child child(words, {}, folder.path());
        for (int k = 0; k < 10000 && !exists(std::string("i/") + reached); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        kill(child.pid(), SIGINT);
        child.wait();
    }
    ASSERT_NO_FATAL_FAILURE(succeeds("i"));
    EXPECT_EQ(untimed(contents("i")), untimed(before));
}

TEST_F(Experiment, PlansWithoutWriting) {
    const Outcome o = experiment("d", {"--dry-run", "--json"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_FALSE(exists("d"));
    const auto plan = nlohmann::json::parse(o.out);
    EXPECT_EQ(plan["paths"], (3 + 2) * (1 + 2 + 4 + 8 + 4) * 24 * 20);
    EXPECT_EQ(plan["training_steps"], 12);
    EXPECT_EQ(plan["dims"], nlohmann::json({20, 24, 18}));
    EXPECT_EQ(plan["volume_bytes"], 20 * 24 * 18); // foam is u8
    double seconds = 0;
    for (const auto& stage : plan["stages"]) {
        EXPECT_GT(stage["seconds"].get<double>(), 0) << stage["stage"];
        seconds += stage["seconds"].get<double>();
    }
    EXPECT_NEAR(plan["seconds"].get<double>(), seconds, 1e-9);
    EXPECT_GT(plan["device_bytes"].get<double>(), 2 * 4 * 16 * 16 * 13);
    // The files of the pairs are at most as large as it says.
    ASSERT_NO_FATAL_FAILURE(succeeds("d"));
    std::uintmax_t bytes = 0;
    for (const auto& [name, content] : contents("d")) bytes += content.size();
    EXPECT_LT(bytes, plan["disk_bytes"].get<std::uintmax_t>());
}

TEST_F(Experiment, TakesAVolumeFile) {
    ASSERT_EQ(run({"dataset", "make", "foam", "--dims", "20x24x18", "-o", path("mine.nii")}).exit_code, 0);
    std::vector<std::string> words{"experiment", path("mine.nii"), "-o", path("f")},
        instead{"experiment", "snake", "--volume", path("mine.nii"), "-o", path("g")};
    for (std::vector<std::string>* w : {&words, &instead})
        for (std::size_t k = 0; k < smallest.size(); ++k) // all but --dims
            if (smallest[k] == "--dims")
                ++k;
            else
                w->push_back(smallest[k]);
    const Outcome o = run(words);
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_FALSE(exists("f/volume.nii"));
    EXPECT_EQ(nlohmann::json::parse(text("f/results.json"))["scene"], "mine");
    const Outcome i = run(instead);
    ASSERT_EQ(i.exit_code, 0) << i.err;
    const auto scenes = [&](const std::string& name) { return nlohmann::json::parse(text(name + "/train/pairs.json"))["scenes"]; };
    EXPECT_EQ(scenes("f")[0]["volume_sha256"], scenes("g")[0]["volume_sha256"]);
    EXPECT_NE(scenes("f")[0]["transfer"], scenes("g")[0]["transfer"]); // the snake's own
}

TEST_F(Experiment, RefusesWithOneLine) {
    folder.write("file", "");
    const std::pair<std::vector<std::string>, int> cases[] = {
        {{"experiment"}, 2},
        {{"experiment", "unicorn"}, 2},
        {{"experiment", "bonsai"}, 2}, // nothing stands in for it
        {{"experiment", "snake", "--scale", "huge"}, 2},
        {{"experiment", "vessels", "--fetch"}, 2},
        {{"experiment", "snake", "--fetch", "--volume", path("none")}, 2},
        {{"experiment", "snake", "--scale", "tiny", "--volume", path("none"), "-o", path("n")}, 3},
        {{"experiment", "snake", "--scale", "tiny", "--patch", "97", "-o", path("n")}, 2},
        {{"experiment", "snake", "--scale", "tiny", "--size", "40x40", "-o", path("n")}, 2}, // patches of 64
        {{"experiment", "snake", "--scale", "tiny", "--dims", "9x9", "-o", path("n")}, 2},
        {{"experiment", "snake", "--scale", "tiny", "--tf", "none", "-o", path("n")}, 2},
        {{"experiment", "snake", "--scale", "tiny", "--steps", "5", "--epochs", "5", "-o", path("n")}, 2},
        {{"experiment", "snake", "--scale", "tiny", "-o", path("file")}, 3},
        {{"experiment", "snake", "--scale", "tiny", "-o", "/proc/none/of/this"}, 3},
        {{"ablation"}, 2},
        {{"ablation", path("none")}, 2},
        {{"ablation", path("none"), "--test", path("none")}, 2},
        {{"ablation", path("none"), "--test", path("none"), "-o", path("a")}, 3},
        {{"ablation", path("none"), "--test", path("none"), "-o", path("a"), "--rows", "colour,smell"}, 2},
        {{"ablation", path("none"), "--test", path("none"), "-o", path("a"), "--steps", "0"}, 2},
    };
    for (const auto& [words, code] : cases) {
        const Outcome o = run(words);
        EXPECT_EQ(o.exit_code, code) << testing::PrintToString(words) << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
    for (const char* name : {"a", "n"}) EXPECT_FALSE(exists(name)) << name;
}

TEST_F(Experiment, AblationComparesRows) {
    for (const auto& [name, split, seed] : {std::tuple("t1", "train", "1"), {"t2", "train", "2"}, {"v1", "test", "1"}, {"v2", "test", "2"}})
        ASSERT_EQ(run({"pairs", "demo:vessels", "-o", path(name), "--views", "2", "--size", "24x20", "--noisy-spp", "1,4",
                       "--reference-spp", "8", "--split", split, "--seed", seed, "--feature-samples", "1"})
                      .exit_code,
                  0);
    const auto ablation = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"ablation", path("t1"), path("t2"), "--test",  path("v1"), "--test",  path("v2"), "-o",
                                       path("a"),  "--steps",  "6",        "--patch", "16",       "--batch", "2"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    };
    const Outcome o = ablation({"--rows", "colour,no-demodulation,opacity"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.out, AllOf(HasSubstr("noisy input"), HasSubstr("colour only"), HasSubstr("without demodulation"),
                             testing::ContainsRegex("v1 . +v2"), HasSubstr("4 spp: SSIM"), Not(HasSubstr("noise level"))));
    const auto table = nlohmann::json::parse(text("a/ablation.json"));
    ASSERT_EQ(table["rows"].size(), 4u);
    EXPECT_EQ(table["rows"][0]["name"], "noisy");
    EXPECT_EQ(table["rows"][1]["name"], "colour"); // in the table's order, not the command line's
    EXPECT_EQ(table["rows"][2]["name"], "opacity");
    for (const auto& row : table["rows"]) ASSERT_EQ(row["scores"].size(), 4u); // two tests at two numbers of samples
    EXPECT_NE(table["rows"][2]["scores"], table["rows"][3]["scores"]);         // demodulation is seen
    EXPECT_THAT(text("a/ablation.md"), HasSubstr(o.out));

    // Another row joins; those that are there stay as they are.
    const auto before = contents("a");
    const Outcome more = ablation({"--rows", "colour,no-demodulation,opacity,noise"});
    ASSERT_EQ(more.exit_code, 0) << more.err;
    EXPECT_EQ(nlohmann::json::parse(text("a/ablation.json"))["rows"].size(), 5u);
    const auto after = contents("a");
    for (const auto& [name, content] : before)
        if (name != "ablation.json" && name != "ablation.md" && name != "stages.json") {
            EXPECT_EQ(after.at(name), content) << name;
        }
    // A lost measurement is taken again, to the same table; training is not.
    std::filesystem::remove(folder.path() / "a/noise.json");
    const Outcome again = ablation({"--rows", "colour,no-demodulation,opacity,noise"});
    EXPECT_EQ(again.out, more.out);
    EXPECT_THAT(again.err, Not(HasSubstr("training")));

    EXPECT_EQ(ablation({"--spp", "1,2"}).exit_code, 3); // there are frames of 1 and 4
    EXPECT_EQ(ablation({"--lr", "0.01"}).exit_code, 3); // another ablation's folder
    EXPECT_EQ(run({"ablation", path("t1"), "--test", path("v1"), "-o", path("b"), "--patch", "25", "--steps", "2"}).exit_code,
              2); // larger than the pictures
}

} // namespace
} // namespace clvr
