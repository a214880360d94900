// `clvr experiment snake --scale tiny` from nothing to a report.
#include "tests/cli/experiment_folder.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <csignal>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TinyExperiment : public ExperimentFolder {};

TEST_F(TinyExperiment, GoesFromNothingToAReportThatShowsTheGain) {
    const std::vector<std::string> words{"experiment", "snake", "--scale", "tiny", "-o", path("e")};
    std::vector<std::string> planned = words;
    planned.push_back("--dry-run");
    const Outcome plan = run(planned);
    EXPECT_THAT(plan.out, AllOf(HasSubstr("96 x 96 x 75 u8"), HasSubstr("6 + 3 of 96x96"), HasSubstr("600 steps"),
                                HasSubstr("Estimated from a probe")));
    EXPECT_FALSE(exists("e"));
    for (const int seconds : {5, 15}) { // Ctrl-C; that the bits stay the same is tested with the smallest experiment
        Child child(words, {}, folder.path());
        std::this_thread::sleep_for(std::chrono::seconds(seconds));
        kill(child.pid(), SIGINT);
        const Outcome stopped = child.wait();
        EXPECT_TRUE(stopped.exit_code == 130 || stopped.exit_code == 0) << stopped.err;
    }
    const Outcome o = run(words);
    ASSERT_EQ(o.exit_code, 0) << o.err;
    for (const char* name : {"experiment.json", "volume.nii", "train/pairs.json", "test/view_0002_reference.exr", "model.safetensors",
                             "model.training.csv", "evaluation.json", "results.json", "results.md", "report.html"})
        EXPECT_TRUE(exists(std::string("e/") + name)) << name;
    const auto results = nlohmann::json::parse(text("e/results.json"));
    const double gains[] = {8, 6, 4, 2.5}; // [dB] at 1, 2, 4, 8 spp; measured: 12.8, 9.4, 7.3, 5.0
    for (std::size_t k = 0; k < 4; ++k) {
        const auto& mean = results["frames"][k]["mean"];
        EXPECT_GT(mean["clvr"]["psnr"].get<double>(), mean["noisy"]["psnr"].get<double>() + gains[k]) << (1 << k) << " spp";
        EXPECT_GT(mean["clvr"]["ssim"].get<double>(), mean["noisy"]["ssim"].get<double>() + 0.02) << (1 << k) << " spp";
    }
    EXPECT_THAT(text("e/results.md"), HasSubstr(o.out));
    const std::string html = text("e/report.html");
    for (const char* part :
         {"data:image/png;base64,", "Means by noisy input", "4 spp: Mean of 3 views", "training loss", "cross-bilateral", "FLIP"})
        EXPECT_THAT(html, HasSubstr(part));
    EXPECT_EQ(html.find("<script"), html.npos);

    const auto before = contents("e");
    ASSERT_EQ(run(words).exit_code, 0);
    EXPECT_EQ(contents("e"), before);
    std::filesystem::remove(folder.path() / "e/report.html");
    ASSERT_EQ(run(words).exit_code, 0);
    EXPECT_EQ(contents("e"), before); // the report alone was made again
}

} // namespace
} // namespace clvr
