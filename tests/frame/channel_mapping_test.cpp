#include "host/frame/channel_mapping.hpp"
#include "runtime/error.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A frame of one pixel; the k-th channel holds k.
Frame frame_with(const std::vector<std::string>& names) {
    Frame frame;
    frame.width = frame.height = 1;
    float k = 0;
    for (const auto& name : names) frame.channels[name] = {k++};
    return frame;
}

TEST(ChannelMappingTest, ByWish) {
    Frame frame = frame_with({"DiffCol.R", "DiffCol.G", "DiffCol.B", "N.x", "N.y", "N.z", "Depth.V", "Combined.R", "Combined.A", "grey"});
    map_channels(frame, "albedo=DiffCol");
    EXPECT_EQ(frame.at("albedo.G")[0], 1);
    map_channels(frame, "normal=N");
    EXPECT_EQ(frame.at("normal.Z")[0], 5);
    map_channels(frame, "depth.Z=Depth.V");
    EXPECT_EQ(frame.at("depth.Z")[0], 6);
    map_channels(frame, "beauty=Combined");
    EXPECT_EQ(frame.at("R")[0], 7);
    EXPECT_EQ(frame.at("A")[0], 8);
    map_channels(frame, "albedo=grey");
    EXPECT_EQ(frame.at("albedo.B")[0], 9);
    map_channels(frame, "G=grey");
    EXPECT_EQ(frame.at("G")[0], 9);
    map_channels(frame, "variance=DiffCol");
    EXPECT_EQ(frame.at("variance.B")[0], 2);
    const auto said = [&](const std::string& mapping) {
        try {
            map_channels(frame, mapping);
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_THAT(said("albedo=none"), HasSubstr("has no channel none or none.*"));
    EXPECT_THAT(said("albedo"), HasSubstr("expected CLVR'S=THEIRS"));
    EXPECT_THAT(said("=x"), HasSubstr("expected CLVR'S=THEIRS"));
    EXPECT_THAT(said("normal=grey"), HasSubstr("one channel"));
}

TEST(ChannelMappingTest, NamesOfCycles) {
    Frame frame = frame_with({"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A",
                              "ViewLayer.DiffCol.R", "ViewLayer.DiffCol.G", "ViewLayer.DiffCol.B", "ViewLayer.Denoising Albedo.R",
                              "ViewLayer.Denoising Albedo.G", "ViewLayer.Denoising Albedo.B", "ViewLayer.Denoising Normal.X",
                              "ViewLayer.Denoising Normal.Y", "ViewLayer.Denoising Normal.Z", "ViewLayer.Depth.V"});
    const std::vector<std::string> said = map_known_channels(frame);
    EXPECT_EQ(frame.at("G")[0], 1);
    EXPECT_EQ(frame.at("A")[0], 3);
    EXPECT_EQ(frame.at("albedo.R")[0], 7) << "the one for denoisers before DiffCol";
    EXPECT_EQ(frame.at("normal.Y")[0], 11);
    EXPECT_FALSE(frame.has("depth.Z"));
    EXPECT_THAT(said, ElementsAre("ViewLayer.Combined.* is taken as R G B", "ViewLayer.Denoising Albedo.* is taken as albedo.*",
                                  "ViewLayer.Denoising Normal.* is taken as normal.*",
                                  "ViewLayer.Depth.* is not taken as depth.Z: it is no share 0..1"));
}

TEST(ChannelMappingTest, NamesOfOthers) {
    for (const char* name : {"albedo", "Albedo", "DiffCol", "diffuse_filter", "VRayDiffuseFilter", "denoise_albedo", "VisibleDiffuse"}) {
        const std::string layer = name;
        Frame frame = frame_with({"R", "G", "B", layer + ".r", layer + ".g", layer + ".b"});
        map_known_channels(frame);
        ASSERT_TRUE(frame.has("albedo.B")) << layer;
        EXPECT_EQ(frame.at("albedo.G")[0], 4) << layer;
        EXPECT_EQ(frame.at("G")[0], 1);
    }
    for (const char* name : {"N", "Normal", "normals", "VRayNormals", "Nn"}) {
        const std::string layer = name;
        Frame frame = frame_with({"R", "G", "B", layer + ".R", layer + ".G", layer + ".B"});
        map_known_channels(frame);
        ASSERT_TRUE(frame.has("normal.Z")) << layer;
        EXPECT_EQ(frame.at("normal.Z")[0], 5) << layer;
    }
    Frame lower = frame_with({"r", "g", "b", "a"});
    map_known_channels(lower);
    EXPECT_EQ(lower.at("B")[0], 2);
    EXPECT_EQ(lower.at("A")[0], 3);
    Frame share = frame_with({"Z"}); // 0: a share
    EXPECT_THAT(map_known_channels(share), ElementsAre("Z is taken as depth.*"));
}

TEST(ChannelMappingTest, OwnNamesStay) {
    Frame frame = frame_with({"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "N.X",
                              "N.Y", "N.Z", "Combined.R", "Combined.G", "Combined.B"});
    const auto before = frame.channels;
    EXPECT_THAT(map_known_channels(frame), IsEmpty());
    EXPECT_EQ(frame.channels, before);
}

TEST(ShownPartTest, CutsAndPads) {
    Frame frame = frame_with({"R"});
    frame.width = 3, frame.height = 2, frame.x = -1, frame.y = 0;
    frame.channels["R"] = {1, 2, 3, 4, 5, 6};
    EXPECT_EQ(shown_part(frame).at("R"), frame.at("R"));
    frame.display = Region{0, -1, 3, 2};
    const Frame part = shown_part(frame);
    EXPECT_EQ(part.window(), (Region{0, 0, 3, 2}));
    EXPECT_THAT(part.at("R"), ElementsAre(0, 0, 0, 2, 3, 0));
    frame.display = Region{100, 100, 2, 1};
    EXPECT_THAT(shown_part(frame).at("R"), ElementsAre(0, 0));
}

} // namespace
} // namespace clvr
