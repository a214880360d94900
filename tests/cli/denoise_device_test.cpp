// `clvr denoise` and `clvr compare` on pictures of other programs.
#include "host/io/picture/frame_file.hpp"
#include "tests/cli/program.hpp"
#include "tests/io/exr_writers.hpp"
#include "tests/io/frames.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> colours{"R", "G", "B"};

class Denoising : public testing::Test {
protected:
    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    Outcome run(const std::vector<std::string>& words) const { return Child(words, {}, folder.path()).wait(); }
    /// Denoises IN to d.exr with further words, which must succeed.
    Outcome denoise(const std::string& in, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"denoise", path(in), "-o", path("d.exr")};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome o = run(words);
        EXPECT_EQ(o.exit_code, 0) << o.err;
        return o;
    }
    /// 24 x 20 pixels of noise between 0 and 1 in the channels.
    Frame noise(const std::vector<std::string>& channels) const {
        Frame frame = test::noise(24, 20, channels);
        for (auto& [name, values] : frame.channels)
            for (float& v : values) v = (v + 1) / 3;
        return frame;
    }
    static double spread(const std::vector<float>& values) {
        double sum = 0, squares = 0;
        for (const float v : values) sum += v, squares += static_cast<double>(v) * v;
        const double n = static_cast<double>(values.size());
        return squares / n - sum / n * (sum / n);
    }
    TemporaryFolder folder;
};

TEST_F(Denoising, ChoosesTheModelByWhatThePictureHas) {
    write_exr(noise(colours), path("rgb.exr"));
    const Outcome rgb = denoise("rgb.exr");
    EXPECT_THAT(rgb.err, AllOf(HasSubstr("the model color;"), HasSubstr("it lacks albedo opacity light normal depth noise\n")));
    Frame clean = read_exr(path("d.exr"));
    EXPECT_EQ(clean.at("noisy.G"), noise(colours).at("G"));
    EXPECT_LT(spread(clean.at("R")), 0.5 * spread(clean.at("noisy.R"))) << "it takes noise away";

    std::vector<std::string> named = colours;
    named.insert(named.end(), {"DiffCol.R", "DiffCol.G", "DiffCol.B"});
    write_exr(noise(named), path("mapped.exr"));
    EXPECT_THAT(denoise("mapped.exr", {"--map", "albedo=DiffCol"}).err,
                AllOf(HasSubstr("normal is taken as 0"), HasSubstr("the model color-albedo-normal;")));
    EXPECT_TRUE(read_exr(path("d.exr")).has("albedo.G"));
    EXPECT_FALSE(read_exr(path("d.exr")).has("normal.X")) << "what was made for the model alone is not written";
    named.insert(named.end(), {"N.X", "N.Y", "N.Z"});
    write_exr(noise(named), path("guided.exr"));
    EXPECT_THAT(denoise("guided.exr").err, AllOf(HasSubstr("DiffCol.* is taken as albedo.*"), HasSubstr("the model color-albedo-normal;")));
    const Frame guided = read_exr(path("d.exr"));
    EXPECT_EQ(guided.at("normal.Y"), noise(named).at("N.Y"));

    std::vector<std::string> all = colours;
    all.insert(all.end(), {"A", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "opacity.A",
                           "depth.deviation", "depth.half"});
    write_exr(noise(all), path("all.exr"));
    EXPECT_THAT(denoise("all.exr").err, AllOf(HasSubstr("the model color-albedo-normal;"), HasSubstr("--spp")));
    EXPECT_THAT(denoise("all.exr", {"--spp", "4"}).err, HasSubstr("the model features; for the one that reads the most it lacks light\n"));
    const std::string chosen = pixel_hash(read_exr(path("d.exr")));
    denoise("all.exr", {"--spp", "4", "--model", "features"});
    EXPECT_EQ(pixel_hash(read_exr(path("d.exr"))), chosen);

    const Outcome lacks = run({"denoise", path("rgb.exr"), "-o", path("e.exr"), "--model", "default"});
    EXPECT_EQ(lacks.exit_code, 3);
    EXPECT_THAT(lacks.err, AllOf(HasSubstr("lacks channels albedo.R"), HasSubstr("--model color reads only what it has")));
    EXPECT_FALSE(std::filesystem::exists(path("e.exr")));
    write_exr(noise({"R", "G", "left.B"}), path("part.exr"));
    const Outcome part = run({"denoise", path("part.exr"), "-o", path("e.exr")});
    EXPECT_EQ(part.exit_code, 3);
    EXPECT_THAT(part.err, AllOf(HasSubstr("lacks channel B"), HasSubstr("--map beauty=LAYER")));
}

TEST_F(Denoising, TakesPassesFromFilesOfTheirOwn) {
    write_exr(noise(colours), path("rgb.exr"));
    write_exr(noise({"R", "G", "B", "A"}), path("albedo.exr"));
    EXPECT_THAT(denoise("rgb.exr", {"--albedo", path("albedo.exr"), "--normal", path("albedo.exr")}).err,
                HasSubstr("the model color-albedo-normal;"));
    EXPECT_EQ(read_exr(path("d.exr")).at("normal.Z"), noise({"R", "G", "B", "A"}).at("B"));
    write_exr(test::noise(8, 8, colours), path("small.exr"));
    const Outcome small = run({"denoise", path("rgb.exr"), "--albedo", path("small.exr"), "-o", path("e.exr")});
    EXPECT_EQ(small.exit_code, 3);
    EXPECT_THAT(small.err, AllOf(HasSubstr("small.exr"), HasSubstr("expected 24 x 20")));
}

TEST_F(Denoising, KeepsWindowsAndShowsTheDisplayWindow) {
    const Imath::Box2i data{{8, 6}, {23, 17}}, display{{0, 0}, {31, 23}};
    test::write_parts(path("crop.exr"), {{"rgba", "", {"A", "B", "G", "R"}, data, 1}, {"albedo", "", {"B", "G", "R"}, data, 1}}, display);
    denoise("crop.exr", {"-o", path("d.png"), "-o", path("d.jpg")});
    const Frame frame = read_exr(path("d.exr"));
    EXPECT_EQ(frame.window(), (Region{8, 6, 16, 12}));
    EXPECT_EQ(frame.shown(), (Region{0, 0, 32, 24}));
    EXPECT_TRUE(frame.has("albedo.G"));
    for (const char* name : {"d.png", "d.jpg"}) EXPECT_EQ(read_picture(path(name)).window(), (Region{0, 0, 32, 24})) << name;
    // A crop against the whole picture: as large; against the bare crop: refused.
    const Outcome same = run({"compare", path("d.png"), path("d.exr"), "--tonemap", "filmic"});
    EXPECT_EQ(same.exit_code, 0) << same.err;
    Frame bare = frame;
    bare.x = bare.y = 0, bare.display.reset();
    write_exr(bare, path("bare.exr"));
    const Outcome other = run({"compare", path("bare.exr"), path("d.exr")});
    EXPECT_EQ(other.exit_code, 3);
    EXPECT_THAT(other.err, HasSubstr("16 x 12 pixels against 32 x 24"));
}

TEST_F(Denoising, TakesAnyPicture) {
    Frame flat;
    flat.width = 24, flat.height = 20;
    for (const auto& c : colours) flat.channel(c).assign(flat.pixels(), 0.25f);
    write_png(flat, {"none", 0}, path("flat.png"));
    write_jpeg(flat, {"none", 0}, path("flat.jpg"));
    std::string pfm = "PF\n24 20\n-1\n", hdr = "#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 20 +X 24\n";
    const float quarter = 0.25f;
    for (int i = 0; i < 3 * 24 * 20; ++i) pfm.append(reinterpret_cast<const char*>(&quarter), 4);
    for (int i = 0; i < 24 * 20; ++i) hdr += {'\x80', '\x80', '\x80', '\x80'}; // 0.5, halved
    test::put(path("flat.pfm"), pfm);
    test::put(path("flat.hdr"), hdr);
    for (const char* name : {"flat.png", "flat.jpg", "flat.pfm", "flat.hdr"}) {
        const Outcome o = denoise(name, {"-o", path("d.png")});
        EXPECT_THAT(o.err, HasSubstr("the model color;"));
        const std::vector<float> red = read_exr(path("d.exr")).at("R");
        for (const float r : red) ASSERT_NEAR(r, 0.25, 0.01) << name;
        // A display picture stays as bright as it was; radiance is developed.
        const bool display = std::string(name) == "flat.png" || std::string(name) == "flat.jpg";
        ASSERT_NEAR(read_png(path("d.png")).at("R")[0], display ? 0.25 : 0.25 * 1.3, 0.01) << name;
        EXPECT_EQ(o.err.find("EXPOSURE") != o.err.npos, std::string(name) == "flat.hdr");
    }
}

TEST_F(Denoising, JpegBesidePng) {
    Frame frame = noise({"R", "G", "B", "A"});
    write_exr(frame, path("a.exr"));
    const Outcome o = denoise("a.exr", {"-o", path("d.JPG"), "-o", path("e.jpeg"), "-o", path("d.png"), "--show", "guides"});
    const std::string once = "JPEG has no alpha";
    EXPECT_NE(o.err.find(once), o.err.npos) << o.err;
    EXPECT_EQ(o.err.find(once), o.err.rfind(once)) << o.err;
    EXPECT_EQ(test::bytes_of(path("d.JPG")), test::bytes_of(path("e.jpeg")));
    EXPECT_EQ(picture_format(path("d.JPG")), PictureFormat::jpeg);
    EXPECT_TRUE(std::filesystem::exists(path("d.guide.1.png")));
    const Outcome c = run({"compare", path("d.JPG"), path("d.png"), "--map", path("m.jpg")});
    EXPECT_EQ(c.exit_code, 0) << c.err;
    EXPECT_EQ(picture_format(path("m.flip.jpg")), PictureFormat::jpeg);
    const Outcome bad = run({"denoise", path("a.exr"), "-o", path("d.tif")});
    EXPECT_EQ(bad.exit_code, 3);
    EXPECT_THAT(bad.err, HasSubstr("expected .png or .jpg (a picture) or .exr"));
}

} // namespace
} // namespace clvr
