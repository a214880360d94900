// Files that other files name must not be outputs either: this is found while reading, before anything is written.
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class NamedFiles : public Program {
protected:
    std::string path(const std::string& name) const { return (home.path() / name).string(); }
    std::string text(const std::string& name) const {
        std::ifstream in(home.path() / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// `--save-scene` takes any name: by `link` it names `input`.
    void expect_refused(const std::string& volume, const std::string& input) const {
        const std::string before = text(input);
        ASSERT_FALSE(before.empty()) << input;
        for (const std::string how : {"itself", "symbolic", "hard"}) {
            fs::remove(home.path() / "scene");
            if (how == "symbolic") fs::create_symlink(input, home.path() / "scene");
            if (how == "hard") fs::create_hard_link(home.path() / input, home.path() / "scene");
            const Outcome o = run({"render", path(volume), "-o", path("made.png"), "--size", "16x16", "--spp", "1", "--save-scene",
                                   path(how == "itself" ? input : "scene")});
            EXPECT_EQ(o.exit_code, 2) << input << ", " << how << ": " << o.err;
            EXPECT_THAT(o.err, HasSubstr("must not be overwritten"));
            EXPECT_EQ(text(input), before);
            EXPECT_FALSE(fs::exists(home.path() / "made.png")) << "nothing is written";
        }
    }
};

TEST_F(NamedFiles, VoxelsBesideTheirHeader) {
    fs::rename(ball(), path("voxels.raw"));
    home.write("ball.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 16 16 16\nElementType = MET_UCHAR\nElementDataFile = voxels.raw\n");
    expect_refused("ball.mhd", "voxels.raw");
    home.write("ball.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nencoding: raw\ndata file: voxels.raw\n");
    expect_refused("ball.nhdr", "voxels.raw");
}

TEST_F(NamedFiles, DescriptionOfRawVoxels) {
    fs::rename(ball(), path("ball.raw"));
    home.write("ball.json", R"({"dims": [16, 16, 16], "type": "uint8", "spacing": [1, 1, 1]})");
    expect_refused("ball.raw", "ball.json");
}

TEST_F(NamedFiles, VolumeAndLightOfAScene) {
    ball();
    home.write("sky.hdr",
               std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") + std::string("\x80\x80\x80\x80\x80\x80\x80\x80"));
    const Outcome o = run({"render", path("ball_16x16x16_uint8.raw"), "--environment", path("sky.hdr"), "-o", path("first.png"), "--size",
                           "16x16", "--spp", "1", "--save-scene", path("s.json")});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    expect_refused("s.json", "ball_16x16x16_uint8.raw");
    expect_refused("s.json", "sky.hdr");
    expect_refused("s.json", "s.json");
}

TEST_F(NamedFiles, FoldersMayTakeOutputsBesideTheirSlices) {
    fs::rename(ball(), path("ball_16x16x16_uint8.bin"));
    home.write("ball/voxels.raw", text("ball_16x16x16_uint8.bin"));
    home.write("ball/ball.mhd",
               "ObjectType = Image\nNDims = 3\nDimSize = 16 16 16\nElementType = MET_UCHAR\nElementDataFile = voxels.raw\n");
    for (int k = 0; k < 2; ++k) { // the second time the picture lies there
        const Outcome o = run({"render", path("ball/ball.mhd"), "-o", path("ball/made.png"), "--size", "16x16", "--spp", "1"});
        EXPECT_EQ(o.exit_code, 0) << o.err;
    }
}

} // namespace
} // namespace clvr
