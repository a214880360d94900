// `clvr pairs`, `train`, `denoise` and `compare` as a user sees them.
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "tests/cli/program.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <thread>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Runs in a folder with a small ball and its pairs.
class Learning : public testing::Test {
protected:
    Learning() {
        std::string voxels;
        for (int z = 0; z < 16; ++z)
            for (int y = 0; y < 20; ++y)
                for (int x = 0; x < 24; ++x) {
                    const double dx = (x - 11.5) / 10, dy = (y - 9.5) / 8, dz = (z - 7.5) / 6;
                    voxels += static_cast<char>(std::clamp(400 * (1 - dx * dx - dy * dy - dz * dz), 0.0, 200.0));
                }
        folder.write("ball_24x20x16_uint8.raw", voxels);
        folder.write("ball_24x20x16_uint8.json", R"({"spacing": [1, 1, 1]})");
    }
    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder.path() / name); }
    Outcome run(const std::vector<std::string>& words) const { return Child(words, {}, folder.path()).wait(); }
    Outcome pairs(const std::string& to, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{
            "pairs", path("ball_24x20x16_uint8.raw"), "-o", path(to), "--views", "3", "--size", "24x20", "--reference-spp", "4"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
    std::string hash(const std::string& name) const { return pixel_hash(read_exr(path(name))); }
    static std::string text(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    TemporaryFolder folder;
};

TEST_F(Learning, PairsAreIndependentAndResumable) {
    const Outcome o = pairs("a", {"--noisy-frames", "2"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const Frame noisy = read_exr(path("a/view_0001_noisy_0.exr")), reference = read_exr(path("a/view_0001_reference.exr"));
    for (const char* name : {"R", "A", "albedo.R", "normal.Y", "depth.Z", "opacity.A"}) EXPECT_TRUE(noisy.has(name)) << name;
    EXPECT_TRUE(reference.has("R"));
    EXPECT_FALSE(reference.has("albedo.R"));
    EXPECT_EQ(reference.attributes.at("clvr.spp"), "4");
    const std::string first = hash("a/view_0001_noisy_0.exr"), second = hash("a/view_0001_noisy_1.exr");
    EXPECT_NE(first, second);
    EXPECT_NE(noisy.at("R"), read_exr(path("a/view_0001_noisy_1.exr")).at("R"));
    EXPECT_EQ(noisy.at("albedo.R"), read_exr(path("a/view_0001_noisy_1.exr")).at("albedo.R"));

    std::filesystem::remove(path("a/view_0001_noisy_0.exr"));
    EXPECT_EQ(run({"train", path("a"), "-o", path("m.safetensors")}).exit_code, 3); // not complete
    ASSERT_EQ(pairs("a", {"--noisy-frames", "2"}).exit_code, 0);
    EXPECT_EQ(hash("a/view_0001_noisy_0.exr"), first);

    const Outcome other = pairs("a", {"--noisy-frames", "2", "--spp", "3"});
    EXPECT_EQ(other.exit_code, 3);
    EXPECT_THAT(other.err, HasSubstr("other settings"));
    ASSERT_EQ(run({"pairs", path("a/pairs.json"), "-o", path("again")}).exit_code, 0);
    EXPECT_EQ(hash("again/view_0001_noisy_1.exr"), second);
    ASSERT_EQ(pairs("test", {"--split", "test"}).exit_code, 0);
    EXPECT_NE(read_exr(path("test/view_0001_noisy_0.exr")).at("albedo.R"), noisy.at("albedo.R")); // other views
}

TEST_F(Learning, DatasetsAreListedAndMade) {
    const Outcome list = run({"dataset", "list", "--json"});
    ASSERT_EQ(list.exit_code, 0) << list.err;
    EXPECT_GE(nlohmann::json::parse(list.out).at("datasets").size(), 9u);
    EXPECT_THAT(run({"dataset", "info", "king_snake"}).out, AllOf(HasSubstr("1024 x 1024 x 795"), HasSubstr("dataset make snake")));
    const Outcome made = run({"dataset", "make", "foam", "--dims", "20x24x28", "--type", "u16", "-o", path("foam.nii.gz")});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(run({"info", path("foam.nii.gz")}).out, HasSubstr("20 x 24 x 28 u16"));
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"dataset"},
                                                  {"dataset", "info", "unicorn"},
                                                  {"dataset", "fetch", "bonsai"},
                                                  {"dataset", "make", "foam"},
                                                  {"dataset", "make", "foam", "-o", path("x.nii"), "--dims", "2x2"},
                                                  {"dataset", "make", "unicorn", "-o", path("x.nii")},
                                                  {"dataset", "make", "foam", "-o", path("x.nii"), "--type", "f64"}})
        EXPECT_EQ(run(wrong).exit_code, 2) << wrong.back();
}

TEST_F(Learning, ViewsTakeTransferFunctionsAndZoomsInTurn) {
    const Outcome o = pairs("v", {"--vary-tf", "ct-bone", "--vary-tf", "mr", "--zoom-range", "0.8,1.6", "--noisy-spp", "1,3"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const auto plan = nlohmann::json::parse(text(path("v/pairs.json")));
    ASSERT_EQ(plan.at("scenes").size(), 2u);
    EXPECT_NE(plan.at("scenes")[0].at("transfer"), plan.at("scenes")[1].at("transfer"));
    double low = 2, high = 0;
    for (const auto& view : plan.at("views")) {
        low = std::min(low, view.at("zoom").get<double>());
        high = std::max(high, view.at("zoom").get<double>());
    }
    EXPECT_TRUE(low >= 0.8 && high <= 1.6 && low < high);
    EXPECT_NE(read_exr(path("v/view_0000_noisy_0.exr")).at("albedo.R"), read_exr(path("v/view_0001_noisy_0.exr")).at("albedo.R"));
    EXPECT_EQ(read_exr(path("v/view_0002_noisy_1.exr")).attributes.at("clvr.spp"), "3");
    ASSERT_EQ(run({"pairs", path("v/pairs.json"), "-o", path("w")}).exit_code, 0);
    for (const char* name : {"view_0000_noisy_0.exr", "view_0001_noisy_0.exr"})
        EXPECT_EQ(hash(std::string("v/") + name), hash(std::string("w/") + name));
}

TEST_F(Learning, TrainsDenoisesAndCompares) {
    ASSERT_EQ(pairs("a").exit_code, 0);
    const std::vector<std::string> train{"train", path("a"),  "-o", path("m.safetensors"), "--patch", "16",         "--batch",
                                         "4",     "--epochs", "3",  "--patches-per-image", "6",       "--validate", path("a")};
    const Outcome o = run(train);
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const std::string model = text(path("m.safetensors"));
    for (const char* name : {"m.last.safetensors", "m.checkpoint", "m.training.csv"}) EXPECT_TRUE(exists(name)) << name;

    const Outcome d =
        run({"denoise", path("a/view_0000_noisy_0.exr"), "--model", path("m.safetensors"), "-o", path("d.exr"), "--show", "guides,levels"});
    ASSERT_EQ(d.exit_code, 0) << d.err;
    EXPECT_TRUE(exists("d.guide.1.png") && exists("d.level3.png"));
    EXPECT_EQ(read_exr(path("d.exr")).at("noisy.R"), read_exr(path("a/view_0000_noisy_0.exr")).at("R"));
    const Outcome c = run({"compare", path("d.exr"), path("a/view_0000_reference.exr"), "--json"});
    ASSERT_EQ(c.exit_code, 0) << c.err;
    EXPECT_THAT(c.out, AllOf(HasSubstr("\"psnr\""), HasSubstr("\"ssim\"")));
    EXPECT_EQ(run({"compare", path("d.exr"), path("none.exr")}).exit_code, 3);
    ASSERT_EQ(run({"denoise", path("d.exr"), "--model", path("m.safetensors"), "-o", path("d.png"), "--tonemap", "none"}).exit_code, 0);
    const Outcome maps = run({"compare", path("d.png"), path("a/view_0000_reference.exr"), "--tonemap", "filmic", "--map", path("e.png")});
    ASSERT_EQ(maps.exit_code, 0) << maps.err;
    EXPECT_THAT(maps.out, HasSubstr("flip"));
    EXPECT_TRUE(exists("e.flip.png") && exists("e.difference.png"));

    const Outcome e = run({"eval", path("a"), "--model", path("m.safetensors"), "--tune", path("a"), "--report", path("r.html"), "--json"});
    ASSERT_EQ(e.exit_code, 0) << e.err;
    const auto json = nlohmann::json::parse(e.out);
    for (const char* name : {"noisy", "m", "cross-bilateral", "wavelet"})
        for (const char* measure : {"psnr", "ssim", "ssim_opaque", "rmse", "smape", "relmse", "flip"})
            EXPECT_TRUE(json["mean"][name][measure].is_number()) << name << measure;
    ASSERT_EQ(json["views"].size(), 3u);
    EXPECT_NEAR(json["views"][0]["m"]["psnr"].get<double>(), nlohmann::json::parse(c.out)["psnr"].get<double>(), 1e-9);
    EXPECT_EQ(json["views"][0]["frame"], "view_0000_noisy_0.exr");
    const std::string html = text(path("r.html"));
    EXPECT_THAT(html, AllOf(HasSubstr("data:image/png;base64,"), HasSubstr("training loss"), HasSubstr("reference"), HasSubstr("FLIP")));
    EXPECT_EQ(html.find("http://"), html.npos);
    EXPECT_EQ(html.find("<script"), html.npos);

    const Outcome r = run({"render", path("ball_24x20x16_uint8.raw"), "--size", "30x26", "--spp", "1", "--denoise", "--model",
                           path("m.safetensors"), "-o", path("r.exr"), "-o", path("r.png")});
    ASSERT_EQ(r.exit_code, 0) << r.err;
    EXPECT_TRUE(read_exr(path("r.exr")).has("noisy.G"));
    EXPECT_TRUE(exists("r.png"));

    const Outcome over = run({"render", path("ball_24x20x16_uint8.raw"), "--size", "30x26", "--spp", "1", "--denoise", "--model",
                              path("m.safetensors"), "--background", "#4080c0", "-o", path("o.exr"), "-o", path("o.png")});
    ASSERT_EQ(over.exit_code, 0) << over.err;
    EXPECT_FALSE(read_picture(path("o.png")).has("A"));
    const Frame clear = read_exr(path("r.exr")), laid = read_exr(path("o.exr"));
    for (std::size_t i = 0; i < laid.pixels(); ++i)
        ASSERT_NEAR(laid.at("G")[i], clear.at("G")[i] + (1 - clear.at("A")[i]) * laid.at("background.G")[i], 1e-4) << i;

    if (run({"devices", "--device", "cpu/2"}).exit_code == 0) {
        std::vector<std::string> parts = train;
        parts[3] = path("p.safetensors");
        parts.insert(parts.end(), {"--device", "cpu/2"});
        const Outcome two = run(parts);
        ASSERT_EQ(two.exit_code, 0) << two.err;
        EXPECT_EQ(text(path("p.safetensors")), model);
    }

    // SIGKILL at some moment, then --resume: the same model, byte for byte.
    std::vector<std::string> again = train;
    again[3] = path("k.safetensors");
    Child child(again, {}, folder.path());
    for (int tries = 0; tries < 1000 && !exists("k.checkpoint"); ++tries) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(child.pid(), SIGKILL);
    child.wait();
    ASSERT_TRUE(exists("k.checkpoint"));
    again.push_back("--resume");
    const Outcome resumed = run(again);
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(text(path("k.safetensors")), model);

    const Outcome levels = run({"train", path("a"), "-o", path("l.safetensors"), "--patch", "16", "--batch", "4", "--epochs", "1",
                                "--patches-per-image", "2", "--levels", "2:8,4:4"});
    ASSERT_EQ(levels.exit_code, 0) << levels.err;
    const Model finer = read_model(path("l.safetensors"));
    ASSERT_EQ(finer.levels.size(), 2u);
    EXPECT_EQ(finer.levels[0].pixels, 2);
    EXPECT_EQ(finer.levels[0].codes, 8);
}

TEST_F(Learning, RefusesWithOneLine) {
    const std::pair<std::vector<std::string>, int> cases[] = {
        {{"pairs", path("ball_24x20x16_uint8.raw")}, 2},
        {{"pairs", path("ball_24x20x16_uint8.raw"), "-o", path("p"), "--views", "0"}, 2},
        {{"pairs", path("ball_24x20x16_uint8.raw"), "-o", path("p"), "--reference-spp", "0"}, 2},
        {{"pairs", path("ball_24x20x16_uint8.raw"), "-o", path("p"), "--zoom-range", "2,1"}, 2},
        {{"train", "-o", path("m.safetensors")}, 2},
        {{"train", path("none"), "-o", path("m.safetensors")}, 3},
        {{"train", path("none"), "-o", path("m.safetensors"), "--loss", "huber"}, 2},
        {{"train", path("none"), "-o", path("m.safetensors"), "--conv", "fft"}, 2},
        {{"train", path("none"), "-o", path("m.safetensors"), "--levels", "4:4,8"}, 2},
        {{"train", path("none"), "-o", path("m.safetensors"), "--levels", "4:4x"}, 2},
        {{"train", path("none"), "-o", path("m.safetensors"), "--levels", "0:4"}, 2},
        {{"train", path("none"), "-o", path("m.safetensors"), "--levels", "1:4,2:4,3:4,4:4,5:4,6:4,7:4,8:4,9:4"}, 2},
        {{"train", path("none"), "-o", path("m.safetensors"), "--levels", "4:4", "--init", "default"}, 2},
        {{"compare", path("none.exr"), path("none.exr"), "--map", path("e.exr")}, 2},
        {{"compare", path("none.exr"), path("none.exr"), "--tonemap", "sepia"}, 2},
        {{"compare", path("none.png"), path("none.png")}, 3},
        {{"compare", path("ball_24x20x16_uint8.json"), path("none.png")}, 3},
        {{"eval", path("none")}, 3},
        {{"eval", path("none"), "--model", path("none.safetensors")}, 3},
        {{"denoise", path("none.exr"), "-o", path("d.png")}, 3},
        {{"denoise", path("none.exr"), "-o", path("d.png"), "--model", path("none.safetensors")}, 3},
        {{"denoise", path("none.exr"), "-o", path("d.png"), "--model", path("ball_24x20x16_uint8.raw")}, 3},
        {{"denoise", path("none.exr"), "-o", path("d.png"), "--spp", "-1"}, 2},
        {{"render", path("ball_24x20x16_uint8.raw"), "-o", path("d.png"), "--denoise", "--mode", "dvr"}, 2},
        {{"render", path("ball_24x20x16_uint8.raw"), "-o", path("d.png"), "--denoise", "--model", path("none.safetensors")}, 3},
    };
    for (const auto& [words, code] : cases) {
        const Outcome o = run(words);
        EXPECT_EQ(o.exit_code, code) << words[0] << ": " << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
    EXPECT_FALSE(exists("d.png"));
}

} // namespace
} // namespace clvr
