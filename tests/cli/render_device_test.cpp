// `clvr render` as a user sees it: pictures, scenes, sequences, interruption, bad input.
#include "host/io/picture/frame_file.hpp"
#include "tests/cli/program.hpp"
#include "tests/io/frames.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Runs in a folder with a small ball: 24x20x16 u8, bright inside.
class Render : public testing::Test {
protected:
    Render() {
        std::string voxels;
        for (int z = 0; z < 16; ++z)
            for (int y = 0; y < 20; ++y)
                for (int x = 0; x < 24; ++x) {
                    const double dx = (x - 11.5) / 10, dy = (y - 9.5) / 8, dz = (z - 7.5) / 6;
                    voxels += static_cast<char>(std::clamp(400 * (1 - dx * dx - dy * dy - dz * dz), 0.0, 200.0));
                }
        folder.write("ball_24x20x16_uint8.raw", voxels);
        folder.write("ball_24x20x16_uint8.json", R"({"spacing": [1, 1, 1]})");
        folder.write("dense.json", R"({"domain": "physical", "points": [{"value": 20, "color": [0.9, 0.5, 0.4], "opacity": 0},
                                                                          {"value": 150, "color": [0.9, 0.8, 0.7], "opacity": 0.9}]})");
    }
    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder.path() / name); }

    /// Names that end like files of the test's folder are taken from there.
    std::vector<std::string> arguments_of(const std::vector<std::string>& words) const {
        std::vector<std::string> arguments{"render"};
        for (const auto& word : words) {
            const std::string ending = std::filesystem::path(word).extension().string();
            const bool file = word.find('/') == std::string::npos &&
                              (ending == ".raw" || ending == ".json" || ending == ".png" || ending == ".exr" || ending == ".hdr");
            arguments.push_back(file ? path(word) : word);
        }
        return arguments;
    }
    Outcome run(const std::vector<std::string>& words, const Environment& environment = {}) const {
        return Child(arguments_of(words), environment, folder.path()).wait();
    }
    /// The ball at 40x36, 2 samples, with its transfer function; `more` comes after.
    Outcome run_ball(const std::vector<std::string>& more, const Environment& environment = {}) const {
        std::vector<std::string> words{"ball_24x20x16_uint8.raw", "--tf", "dense.json", "--size", "40x36", "--spp", "2"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words, environment);
    }
    std::string hash(const std::string& name) const { return pixel_hash(read_exr(path(name))); }

    TemporaryFolder folder;
};

TEST_F(Render, WritesPictureAndChannels) {
    const Outcome o = run_ball({"-o", "a.png", "-o", "a.exr"});
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(o.err, "");
    EXPECT_TRUE(exists("a.png"));
    const Frame frame = read_exr(path("a.exr"));
    EXPECT_EQ(frame.width, 40);
    EXPECT_EQ(frame.height, 36);
    for (const char* name :
         {"R", "G", "B", "A", "albedo.R", "normal.Z", "depth.Z", "opacity.A", "depth.deviation", "depth.half", "variance.G"})
        EXPECT_TRUE(frame.has(name)) << name;
    EXPECT_FALSE(frame.has("background.R"));
    EXPECT_EQ(frame.attributes.at("clvr.spp"), "2");
    for (const char* name : {"clvr.version", "clvr.volume.sha256", "clvr.scene", "clvr.seed", "clvr.device", "clvr.kernels.sha256"})
        EXPECT_NE(frame.attributes.at(name), "") << name;
    // The ball is framed: opaque in the middle, clear in the corners.
    EXPECT_GT(frame.at("opacity.A")[18 * 40 + 20], 0.9f);
    for (const std::size_t corner : {0, 39, 35 * 40, 35 * 40 + 39}) EXPECT_EQ(frame.at("opacity.A")[corner], 0.0f);
}

TEST_F(Render, EveryOrderOfOptionsAndArguments) {
    const std::vector<std::string> options{"--tf", "dense.json", "--size", "20x16", "--spp", "1", "-o", "a.png", "-o", "a.exr"};
    std::vector<std::string> before = options, after = options;
    before.push_back("ball_24x20x16_uint8.raw");
    after.insert(after.begin(), "ball_24x20x16_uint8.raw");
    for (const auto& words : {before, after}) {
        const Outcome o = run(words);
        ASSERT_EQ(o.exit_code, 0) << o.err;
        EXPECT_TRUE(std::filesystem::remove(path("a.png")) && std::filesystem::remove(path("a.exr")));
    }
}

TEST_F(Render, AVolumeAloneWritesAPictureBesideIt) {
    const auto clvr = [&](std::vector<std::string> words) { return Child(words, {}, folder.path()).wait(); };
    const std::string ball = path("ball_24x20x16_uint8.raw"), picture = path("ball_24x20x16_uint8.png");
    ASSERT_EQ(clvr({ball, "--size", "20x16", "--spp", "1"}).exit_code, 0);
    EXPECT_TRUE(std::filesystem::remove(picture));
    ASSERT_EQ(clvr({"--size", "20x16", "--spp", "1", ball}).exit_code, 0);
    const Outcome o = clvr({ball, "--size", "20x16", "--spp", "1"}); // it is there
    EXPECT_EQ(o.exit_code, 2);
    EXPECT_THAT(o.err, AllOf(HasSubstr(picture + ": exists"), HasSubstr("-o ")));
    EXPECT_EQ(clvr({ball, "--size", "20x16", "--spp", "1", "-o", picture}).exit_code, 0);
}

TEST_F(Render, SaysWhatAMistypedWordMayMean) {
    const auto says = [&](std::vector<std::string> words, int code) {
        const Outcome o = Child(words, {}, folder.path()).wait();
        EXPECT_EQ(o.exit_code, code);
        return o.err;
    };
    EXPECT_EQ(says({"rendr"}, 2), "clvr: there is no command or file \"rendr\": did you mean render?\n");
    EXPECT_THAT(says({"render", "scan.nii", "--sp", "4"}, 2), HasSubstr("clvr: render has no option --sp: did you mean --spp?"));
    EXPECT_THAT(says({"dataset", "make", "head", "--dimz", "4"}, 2),
                HasSubstr("clvr: dataset make has no option --dimz: did you mean --dims?"));
    EXPECT_THAT(says({"--nonsense"}, 2), HasSubstr("clvr: there is no option --nonsense (see clvr --help)"));
    EXPECT_EQ(says({"nowhere.nii.gz"}, 3), "clvr: nowhere.nii.gz: does not exist\n");
    const Outcome alone = Child({}, {}, folder.path()).wait();
    EXPECT_EQ(alone.exit_code, 0);
    EXPECT_THAT(alone.out, AllOf(HasSubstr("Usage: clvr COMMAND"), HasSubstr("\nExamples:\n")));
}

TEST_F(Render, SavedScenesGiveThePictureAgainBitForBit) {
    ASSERT_EQ(run_ball({"-o",         "a.exr",         "--save-scene", "scene.json", "--seed",
                        "7",          "--azimuth",     "77.3",         "--phase-g",  "0.3",
                        "--clip-box", "0,0,0,1,1,0.8", "--clip-plane", "1,0.2,0,14", "--background",
                        "#336699",    "--key",         "0.7",          "--fov",      "41"})
                  .exit_code,
              0);
    const Outcome o = run({"scene.json", "-o", "b.exr"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(hash("a.exr"), hash("b.exr"));
    ASSERT_EQ(run({"scene.json", "-o", "c.exr", "--seed", "8"}).exit_code, 0); // an option changes what the file says
    EXPECT_NE(hash("a.exr"), hash("c.exr"));
}

TEST_F(Render, SavedScenesKnowHowToReadARawFile) {
    std::filesystem::copy_file(path("ball_24x20x16_uint8.raw"), path("unnamed.raw"));
    ASSERT_EQ(run({"unnamed.raw", "--dims", "24x20x16", "--type", "uint8", "--spacing", "1,1,2", "--size", "20x16", "--spp", "1", "-o",
                   "a.exr", "--save-scene", "scene.json"})
                  .exit_code,
              0);
    const Outcome o = run({"scene.json", "-o", "b.exr"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(hash("a.exr"), hash("b.exr"));
}

TEST_F(Render, AScenesVolumeIsChecked) {
    ASSERT_EQ(run_ball({"-o", "a.png", "--save-scene", "scene.json"}).exit_code, 0);
    folder.write("ball_24x20x16_uint8.raw", std::string(24 * 20 * 16, 'x'));
    const Outcome o = run({"scene.json", "-o", "b.png"});
    EXPECT_EQ(o.exit_code, 3);
    EXPECT_THAT(o.err, HasSubstr("does not hold the voxels"));
    EXPECT_FALSE(exists("b.png"));
}

TEST_F(Render, TurntableWritesASequenceWithItsOwnNoise) {
    ASSERT_EQ(run_ball({"-o", "turn.exr", "--turntable", "3"}).exit_code, 0);
    EXPECT_FALSE(exists("turn.exr"));
    EXPECT_FALSE(exists("turn_003.exr"));
    EXPECT_NE(hash("turn_000.exr"), hash("turn_001.exr"));
    EXPECT_NE(hash("turn_001.exr"), hash("turn_002.exr"));
}

TEST_F(Render, OtherModesAndLights) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--mode", "dvr"},
                                                 {"--mode", "mip"},
                                                 {"--environment", "1", "--background", "environment", "--shading", "phase"},
                                                 {"--orthographic", "--headlight", "2", "--shading", "gradient"}}) {
        std::vector<std::string> words = more;
        words.insert(words.end(), {"-o", "a.exr", "--no-features"});
        const Outcome o = run_ball(words);
        ASSERT_EQ(o.exit_code, 0) << o.err;
        const Frame frame = read_exr(path("a.exr"));
        const auto& red = frame.at("R");
        EXPECT_GT(*std::max_element(red.begin(), red.end()), 0.1f) << more[1];
        EXPECT_FALSE(frame.has("albedo.R"));
    }
}

TEST_F(Render, ChannelsOfAnExr) {
    const auto names = [&](const std::string& file) {
        std::string all;
        for (const auto& [name, values] : read_exr(path(file)).channels) all += name + " ";
        return all;
    };
    ASSERT_EQ(run_ball({"-o", "all.exr", "-o", "all.png", "--channels", "all"}).exit_code, 0);
    ASSERT_EQ(run_ball({"-o", "beauty.exr", "-o", "beauty.png", "--channels", "beauty"}).exit_code, 0);
    ASSERT_EQ(run_ball({"-o", "over.exr", "--channels", "beauty", "--background", "#405060"}).exit_code, 0);
    EXPECT_EQ(names("beauty.exr"), "A B G R ");
    EXPECT_EQ(names("over.exr"), "B G R ") << "opaque";
    const Frame all = read_exr(path("all.exr")), beauty = read_exr(path("beauty.exr"));
    EXPECT_GT(all.channels.size(), 15u);
    for (const auto& [name, values] : beauty.channels) EXPECT_EQ(values, all.at(name)) << name;
    EXPECT_EQ(beauty.attributes.at("clvr.spp"), all.attributes.at("clvr.spp"));
    EXPECT_EQ(pixel_hash(read_png(path("beauty.png"))), pixel_hash(read_png(path("all.png"))));
    ASSERT_EQ(Child({"denoise", path("all.exr"), "-o", path("clean.exr"), "--channels", "beauty"}, {}, folder.path()).wait().exit_code, 0);
    EXPECT_EQ(names("clean.exr"), "A B G R ");
    const Outcome wrong = run_ball({"-o", "wrong.exr", "--channels", "some"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, ::testing::HasSubstr("expected beauty or all"));
    EXPECT_FALSE(exists("wrong.exr"));
}

TEST_F(Render, DenoisesTheSameBitsOnOneDeviceOnPartsAndAfterwards) {
    for (const std::string spp : {"1", "3"}) {
        SCOPED_TRACE(spp);
        const auto render = [&](std::vector<std::string> words) {
            words.insert(words.begin(), {"ball_24x20x16_uint8.raw", "--tf", "dense.json", "--size", "40x36", "--spp", spp});
            const Outcome o = run(words);
            EXPECT_EQ(o.exit_code, 0) << o.err;
        };
        render({"-o", "noisy.exr"});
        ASSERT_EQ(Child({"denoise", path("noisy.exr"), "-o", path("after.exr")}, {}, folder.path()).wait().exit_code, 0);
        render({"-o", "at_once.exr", "--denoise"});
        EXPECT_EQ(hash("at_once.exr"), hash("after.exr"));
        render({"-o", "one.exr", "-o", "one.png", "--denoise", "--background", "#405060"});
        render({"-o", "parts.exr", "--denoise", "--background", "#405060", "--device", "cpu/2"});
        EXPECT_EQ(hash("one.exr"), hash("parts.exr"));
        render({"-o", "alone.png", "--denoise", "--background", "#405060"}); // downloads the beauty alone
        EXPECT_EQ(test::bytes_of(path("alone.png")), test::bytes_of(path("one.png")));
    }
}

TEST_F(Render, MarchesLightWhereItIsWanted) {
    const auto lights = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"--profile"};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome o = run_ball(words);
        EXPECT_EQ(o.exit_code, 0) << o.err;
        const std::string said = o.out + o.err;
        EXPECT_EQ(said.find("sky_light") == std::string::npos, said.find("direct_light") == std::string::npos) << said;
        return said.find("direct_light") != std::string::npos;
    };
    EXPECT_TRUE(lights({"-o", "a.exr"}));
    EXPECT_TRUE(lights({"-o", "a.png", "--denoise"}));
    EXPECT_TRUE(lights({"-o", "a.exr", "--denoise", "--model", "features"}));
    EXPECT_FALSE(lights({"-o", "a.png", "--denoise", "--model", "features"}));
    EXPECT_FALSE(lights({"-o", "a.png", "--mode", "dvr"}));
    EXPECT_TRUE(lights({"-o", "a.exr", "--mode", "mip"}));
}

TEST_F(Render, InterruptionSavesWhatIsDone) {
    Child child(arguments_of({"ball_24x20x16_uint8.raw", "--tf", "dense.json", "--size", "40x36", "--spp", "1048576", "-o", "a.exr",
                              "--no-features", "--verbose"}),
                {}, folder.path());
    // The first pass may take as long as it likes; the last one is hours away.
    while (child.err().find("samples per pixel done") == std::string::npos && kill(child.pid(), 0) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    kill(child.pid(), SIGINT);
    const Outcome o = child.wait();
    EXPECT_EQ(o.exit_code, 130) << o.err;
    EXPECT_THAT(o.err, HasSubstr("saved what was finished"));
    const int reached = std::stoi(read_exr(path("a.exr")).attributes.at("clvr.spp"));
    EXPECT_GE(reached, 1);
    EXPECT_LT(reached, 1048576);
}

TEST_F(Render, TimeLimitEndsWithWholePasses) {
    const Outcome o = run({"ball_24x20x16_uint8.raw", "--tf", "dense.json", "--size", "40x36", "--time", "0.5", "-o", "a.exr",
                           "--no-features", "--save-scene", "scene.json"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const int reached = std::stoi(read_exr(path("a.exr")).attributes.at("clvr.spp"));
    EXPECT_GE(reached, 1);
    EXPECT_LT(reached, 1 << 20);
    ASSERT_EQ(run({"scene.json", "--spp", std::to_string(reached), "-o", "b.exr", "--no-features"}).exit_code, 0);
    EXPECT_EQ(hash("a.exr"), hash("b.exr"));
}

TEST_F(Render, ListsItsPresets) {
    const Outcome o = run({"--list-tf"});
    EXPECT_EQ(o.exit_code, 0);
    EXPECT_THAT(o.out, AllOf(HasSubstr("ct-bone"), HasSubstr("mr"), HasSubstr("generic")));
}

TEST_F(Render, NothingVisibleIsAWarning) {
    folder.write(
        "outside.json",
        R"({"domain": "physical", "points": [{"value": 900, "color": [1, 1, 1], "opacity": 0}, {"value": 950, "color": [1, 1, 1], "opacity": 1}]})");
    const Outcome o = run({"ball_24x20x16_uint8.raw", "--tf", "outside.json", "--size", "16x16", "--spp", "1", "-o", "a.exr"});
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.err, HasSubstr("nothing is visible"));
    const Frame frame = read_exr(path("a.exr"));
    for (const float a : frame.at("A")) EXPECT_EQ(a, 0.0f);
}

struct Refusal {
    std::vector<std::string> words;
    int exit_code;
    std::string says;
    Environment environment = {};
};

TEST_F(Render, RefusesWithOneLineAndWritesNothing) {
    folder.write("short_24x20x16_uint8.raw", "too short");
    folder.write("empty.json", "{}");
    folder.write("points.json", R"({"domain": "physical", "points": []})");
    folder.write("broken.hdr", "#?RADIANCE\nnonsense");
    const std::string ball = "ball_24x20x16_uint8.raw";
    const std::vector<Refusal> refusals{
        {{}, 2, "no volume given"},
        {{ball}, 2, "no output given"},
        {{ball, "-o", "x.png", "--size", "0x10"}, 2, "--size"},
        {{ball, "-o", "x.png", "--size", "99999x10"}, 2, "--size"},
        {{ball, "-o", "x.png", "--size", "10"}, 2, "WIDTHxHEIGHT"},
        {{ball, "-o", "x.png", "--spp", "0"}, 2, "--spp"},
        {{ball, "-o", "x.png", "--spp", "many"}, 2, "--spp"},
        {{ball, "-o", "x.png", "--phase-g", "1"}, 2, "--phase-g"},
        {{ball, "-o", "x.png", "--mode", "magic"}, 2, "dvr"},
        {{ball, "-o", "x.png", "--tf", "no-such-preset"}, 2, "ct-bone"},
        {{ball, "-o", "x.png", "--background", "#12"}, 2, "#rrggbb"},
        {{ball, "-o", "x.png", "--turntable", "-3"}, 2, "--turntable"},
        {{ball, "-o", "x.png", "--clip-box", "1,2,3"}, 2, "--clip-box"},
        {{ball, "-o", "x.png", "--eye", "1,2,3"}, 2, "target"},
        {{ball, "-o", "x.bmp"}, 3, ".png"},
        {{ball, "-o", "/none/of/this/x.png"}, 3, "/none/of/this/x.png"},
        {{"nowhere.raw", "-o", "x.png"}, 3, "nowhere.raw"},
        {{"short_24x20x16_uint8.raw", "-o", "x.png"}, 3, "7680"},
        {{ball, "-o", "x.png", "--tf", "empty.json"}, 3, "empty.json"},
        {{ball, "-o", "x.png", "--tf", "points.json"}, 3, "points.json"},
        {{ball, "-o", "x.png", "--environment", "nowhere.hdr"}, 3, "nowhere.hdr"},
        {{ball, "-o", "x.png", "--environment", "broken.hdr"}, 3, "broken.hdr"},
        {{ball, "-o", "x.png", "--device", "no such device"}, 4, "no such device"},
        {{ball, "-o", "x.png"}, 4, "CLVR_DEVICE", {{"CLVR_DEVICE", "nonsense"}}},
        {{ball, "-o", "x.png"}, 4, "OpenCL", {{"OCL_ICD_VENDORS", "/none"}}},
        {{ball, "-o", "x.png", "--memory", "100K"}, 5, "a smaller picture"},
        {{ball, "-o", "x.png"}, 5, "a smaller picture", {{"CLVR_MAX_MEMORY", "100K"}}},
        {{ball, "-o", "x.png"}, 5, "more than 8 buffers", {{"CLVR_MAX_ALLOC", "1K"}}},
    };
    for (const Refusal& r : refusals) {
        const Outcome o = run(r.words, r.environment);
        std::string command = "clvr render";
        for (const auto& w : r.words) command += " " + w;
        EXPECT_EQ(o.exit_code, r.exit_code) << command << "\n" << o.err;
        EXPECT_THAT(o.err, HasSubstr(r.says)) << command;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << command << "\n" << o.err;
        EXPECT_FALSE(exists("x.png")) << command;
    }
}

TEST_F(Render, MemoryOfTheMachineIsNoDevicesFailure) {
    if (run_ball({"-o", "one.exr", "--device", "cpu/2"}).exit_code != 0) GTEST_SKIP() << "no CPU of two parts";
    const char* name = "huge_10000x10000x10000_uint8.raw"; // sparse: a terabyte that takes no room
    std::ofstream(folder.path() / name).close();
    std::error_code failed;
    std::filesystem::resize_file(folder.path() / name, 1000000000000u, failed);
    if (failed) GTEST_SKIP() << "no file of a terabyte here: " << failed.message();
    const Outcome o = run({name, "-o", "x.png", "--device", "cpu/2"});
    EXPECT_EQ(o.exit_code, 5) << o.err;
    EXPECT_THAT(o.err, testing::AllOf(HasSubstr(name), HasSubstr("of memory"), testing::Not(HasSubstr("left out"))));
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
}

TEST_F(Render, GoesOnWithoutADeviceThatFails) {
    if (run_ball({"-o", "one.exr", "--device", "cpu/2"}).exit_code != 0) GTEST_SKIP() << "no CPU of two parts";
    const auto faulty = [&](const std::string& fault, const char* device = "cpu/2") {
        return run_ball({"-o", "a.exr", "--device", device}, {{"CLVR_FAULT", fault}});
    };
    const std::string index = nlohmann::json::parse(Child({"devices", "--device", "cpu", "--json"}, {}, folder.path()).wait().out)
                                  .at("selection")
                                  .at("devices")[0]
                                  .at("index")
                                  .dump();
    for (const char* fault : {"launch:20", "alloc:9", "build:render/shade", "result:probe/trust"})
        for (const char* part : {".1", ".2"}) {
            const Outcome o = faulty(fault + ("@" + index) + part);
            EXPECT_EQ(o.exit_code, 0) << fault << part << ": " << o.err;
            const bool builds = std::string(fault) != "build:render/shade"; // else PoCL has a line of its own: "1 error generated."
            EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), builds ? 1 : 2) << o.err;
            EXPECT_THAT(o.err, AllOf(HasSubstr("clvr: warning: part "), HasSubstr("left out")));
            EXPECT_EQ(hash("a.exr"), hash("one.exr")) << fault << part;
        }
    for (const auto& [fault, code] :
         {std::pair("launch:20", 4), {"alloc:9", 5}, {"build:render/shade", 4}, {"result:probe/trust", 4}, {"x", 2}})
        for (const char* device : {"cpu", "cpu/2"}) EXPECT_EQ(faulty(fault, device).exit_code, code) << fault << " " << device;
}

} // namespace
} // namespace clvr
