// What the header of a Radiance file says of its values and their order.
#include "host/io/picture/frame_file.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

using test::error_of;
using test::Folder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Pixels with mantissas r, 2 r, 3 r and the exponent of 2^0: R is r / 256.
std::string pixels(const std::string& reds) {
    std::string bytes;
    for (const char r : reds) bytes += {r, static_cast<char>(2 * r), static_cast<char>(3 * r), static_cast<char>(128)};
    return bytes;
}

Frame read(const std::string& lines, const std::string& resolution, const std::string& rgbe) {
    const Folder folder;
    test::put(folder / "a.hdr", "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n" + rgbe);
    return read_radiance(folder / "a.hdr");
}

TEST(RadianceTest, ExposureAndColourCorrectionAreTakenOut) {
    const std::string rgbe = pixels("\x40");
    EXPECT_THAT(read("", "-Y 1 +X 1", rgbe).at("R"), ElementsAre(0.25f));
    EXPECT_THAT(read("", "-Y 1 +X 1", rgbe).notes, IsEmpty());
    const Frame half = read("EXPOSURE=2\n", "-Y 1 +X 1", rgbe);
    EXPECT_THAT(half.at("R"), ElementsAre(0.125f));
    EXPECT_THAT(half.at("B"), ElementsAre(0.375f));
    EXPECT_THAT(half.notes, ElementsAre(HasSubstr("divided by EXPOSURE")));
    EXPECT_THAT(read("EXPOSURE= 2.000e+00\nSOFTWARE=x=y\nEXPOSURE=4\r\n", "-Y 1 +X 1", rgbe).at("R"), ElementsAre(0.03125f))
        << "lines multiply";
    const Frame colours = read("COLORCORR=1 2 4\nEXPOSURE=0.5\n", "-Y 1 +X 1", rgbe);
    EXPECT_THAT(colours.at("R"), ElementsAre(0.5f));
    EXPECT_THAT(colours.at("G"), ElementsAre(0.5f));
    EXPECT_THAT(colours.at("B"), ElementsAre(0.375f));
    EXPECT_EQ(read("PIXASPECT=0.5\n", "-Y 1 +X 1", rgbe).pixel_aspect, 2);
    EXPECT_THAT(read("PRIMARIES=0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n", "-Y 1 +X 1", rgbe).notes,
                ElementsAre(HasSubstr("PRIMARIES")));
    for (const char* bad :
         {"EXPOSURE=\n", "EXPOSURE=0\n", "EXPOSURE=-2\n", "EXPOSURE=nan\n", "EXPOSURE=two\n", "COLORCORR=1 2\n", "EXPOSURE=1e38\n"})
        EXPECT_THAT(error_of([&] { read(bad, "-Y 1 +X 1", rgbe); }).line(), ::testing::AnyOf(HasSubstr("EXPOSURE"), HasSubstr("COLORCORR")))
            << bad;
}

TEST(RadianceTest, EveryOrientationIsTurnedUpright) {
    // The picture 1 2 3 / 4 5 6 as each order of scanlines stores it.
    const std::pair<const char*, std::string> orders[] = {
        {"-Y 2 +X 3", "\1\2\3\4\5\6"}, {"+Y 2 +X 3", "\4\5\6\1\2\3"}, {"-Y 2 -X 3", "\3\2\1\6\5\4"}, {"+Y 2 -X 3", "\6\5\4\3\2\1"},
        {"+X 3 -Y 2", "\1\4\2\5\3\6"}, {"+X 3 +Y 2", "\4\1\5\2\6\3"}, {"-X 3 -Y 2", "\3\6\2\5\1\4"}, {"-X 3 +Y 2", "\6\3\5\2\4\1"}};
    for (const auto& [resolution, reds] : orders) {
        const Frame frame = read("", resolution, pixels(reds));
        ASSERT_EQ(frame.width, 3) << resolution;
        ASSERT_EQ(frame.height, 2) << resolution;
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(frame.at("R")[i], static_cast<float>(i + 1) / 256) << resolution << i;
        EXPECT_EQ(frame.notes.empty(), std::string(resolution) == "-Y 2 +X 3");
    }
}

TEST(RadianceTest, OldRunsRepeatThePixelBefore) {
    std::string rgbe = pixels("\x10") + std::string("\1\1\1\3", 4) + pixels("\x20"); // 1 + 3 + 1 pixels
    EXPECT_THAT(read("", "-Y 1 +X 5", rgbe).at("R"), ElementsAre(0.0625f, 0.0625f, 0.0625f, 0.0625f, 0.125f));
    rgbe = pixels("\x10") + std::string("\1\1\1\1\1\1\1\1", 8); // 1 + 1 + 256 pixels
    const Frame frame = read("", "-Y 1 +X 258", rgbe);
    for (const float r : frame.at("R")) ASSERT_EQ(r, 0.0625f);
    EXPECT_THAT(error_of([&] { read("", "-Y 1 +X 257", rgbe); }).line(), HasSubstr("a run of 256 pixels"));
    EXPECT_THAT(error_of([&] { read("", "-Y 1 +X 2", std::string("\1\1\1\1", 4)); }).line(), HasSubstr("a run of 1 pixels"));
}

} // namespace
} // namespace clvr
