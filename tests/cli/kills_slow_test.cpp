// SIGKILL at random moments: nothing half-written has a final name, and the next run begins cleanly or continues.
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "tests/cli/home.hpp"
#include "tests/runtime/kills.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

namespace fs = std::filesystem;

class Kills : public Program {
protected:
    std::string path(const std::string& name) const { return (home.path() / name).string(); }

    /// Runs the command to its end; then kills it again and again while it runs, sometimes after removing `result`, and calls
    /// `check` each time; at last runs it to its end once more.
    template <class Check>
    void torture(const std::vector<std::string>& command, const std::string& result, const Check& check) const {
        const auto begin = std::chrono::steady_clock::now();
        const Outcome whole = run(command);
        ASSERT_EQ(whole.exit_code, 0) << whole.err;
        const double life = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        check();
        int killed = 0;
        for (int k = 0; k < kills(); ++k) {
            if (k % 3 == 0) fs::remove_all(path(result)); // the others find what the last one left
            Child child = start(command);
            killed += kill_after(child.pid(), moment(k) * life);
            check();
        }
        EXPECT_GT(killed, 0);
        const Outcome last = run(command);
        EXPECT_EQ(last.exit_code, 0) << last.err;
        check();
        for (const auto& entry : fs::recursive_directory_iterator(home.path() / "out"))
            EXPECT_NE(entry.path().extension(), ".tmp") << entry.path() << ": left by a killed process, and by the next one";
    }
    /// Every picture that has its final name is a whole one.
    void expect_whole_frames(const std::string& folder) const {
        std::error_code none;
        for (const auto& entry : fs::recursive_directory_iterator(home.path() / folder, none))
            if (entry.path().extension() == ".exr") {
                EXPECT_NO_THROW(read_exr(entry.path().string())) << entry.path();
            }
    }

    Kills() { fs::create_directory(home.path() / "out"); }
};

TEST_F(Kills, Render) {
    const std::string picture = path("out/ball.exr");
    torture({"render", ball(), "-o", picture, "--save-scene", path("out/scene.json"), "--size", "64x64", "--spp", "4"}, "out/ball.exr",
            [&] { expect_whole_frames("out"); });
    EXPECT_TRUE(fs::exists(picture));
}

TEST_F(Kills, Pairs) {
    torture({"pairs", ball(), "-o", path("out/pairs"), "--views", "4", "--size", "32x32", "--reference-spp", "8"}, "out/pairs",
            [&] { expect_whole_frames("out"); });
    EXPECT_EQ(files("out/pairs").size(), 9u); // pairs.json, 4 times 2 frames
}

TEST_F(Kills, Train) {
    ASSERT_EQ(run({"pairs", ball(), "-o", path("pairs"), "--views", "2", "--size", "32x32", "--reference-spp", "8"}).exit_code, 0);
    const std::string model = path("out/m/ball.safetensors");
    const auto check = [&] {
        fs::create_directories(home.path() / "out/m");
        for (const auto& entry : fs::directory_iterator(home.path() / "out/m"))
            if (entry.path().extension() == ".safetensors") {
                EXPECT_NO_THROW(read_model(entry.path().string())) << entry.path();
            }
    };
    check();
    torture({"train", path("pairs"), "-o", model, "--epochs", "3", "--batch", "4", "--patch", "16", "--patches-per-image", "8"}, "out/m",
            check);
    const Outcome resumed = run(
        {"train", path("pairs"), "-o", model, "--epochs", "3", "--batch", "4", "--patch", "16", "--patches-per-image", "8", "--resume"});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
}

} // namespace
} // namespace clvr
