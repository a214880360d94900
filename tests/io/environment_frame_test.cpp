// Environment images: Radiance and OpenEXR, whole and broken.
#include "host/io/picture/frame_file.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace clvr {
namespace {

using test::error_of;
using test::Folder;
using ::testing::HasSubstr;

/// A Radiance file of pixels R G B E; `runs` packs each component of a line into literal runs and runs of equal bytes.
std::string radiance(int width, int height, const std::string& rgbe, bool runs,
                     const std::string& header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n") {
    std::string bytes = header + "-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    if (!runs) return bytes + rgbe;
    for (int y = 0; y < height; ++y) {
        bytes += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
        for (int c = 0; c < 4; ++c)
            for (int x = 0; x < width;) {
                const auto value = [&](int i) { return rgbe[static_cast<std::size_t>(4 * (y * width + i) + c)]; };
                int same = 1;
                while (x + same < width && same < 127 && value(x + same) == value(x)) ++same;
                bytes += static_cast<char>(same > 1 ? 128 + same : 1);
                bytes += value(x);
                x += same;
            }
    }
    return bytes;
}

/// Pixel i has the mantissas i, 2 i, 255 and the exponent of 2^(i % 5 - 2).
std::string gradient(int pixels) {
    std::string rgbe;
    for (int i = 0; i < pixels; ++i)
        rgbe += {static_cast<char>(i % 100), static_cast<char>(2 * (i % 100)), static_cast<char>(255), static_cast<char>(128 + i % 5 - 2)};
    return rgbe;
}

void expect_gradient(const RgbImage& image, int width, int height) {
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, height);
    ASSERT_EQ(image.rgb.size(), 3u * static_cast<std::size_t>(width * height));
    for (int i = 0; i < width * height; ++i) {
        const float scale = std::ldexp(1.0f, i % 5 - 2 - 8);
        EXPECT_EQ(image.rgb[3 * i], static_cast<float>(i % 100) * scale) << i;
        EXPECT_EQ(image.rgb[3 * i + 1], static_cast<float>(2 * (i % 100)) * scale) << i;
        EXPECT_EQ(image.rgb[3 * i + 2], 255 * scale) << i;
    }
}

TEST(EnvironmentImageTest, ReadsRadiance) {
    const Folder folder;
    for (bool runs : {false, true}) {
        test::put(folder / "a.hdr", radiance(20, 10, gradient(200), runs));
        expect_gradient(read_environment_image(folder / "a.hdr"), 20, 10);
    }
    test::put(folder / "b.hdr", radiance(300, 2, std::string(2400, '\x40'), true));
    EXPECT_EQ(read_environment_image(folder / "b.hdr").width, 300);
    test::put(folder / "small.hdr", radiance(3, 2, gradient(6), false, "#?RGBE\nFORMAT=32-bit_rle_rgbe\nSOFTWARE=x\n\n"));
    expect_gradient(read_environment_image(folder / "small.hdr"), 3, 2);
}

TEST(EnvironmentImageTest, TruncatedAndFlippedRadianceIsAnErrorOrAnImage) {
    const Folder folder;
    for (bool runs : {false, true}) {
        const std::string whole = radiance(20, 10, gradient(200), runs);
        for (std::size_t size = 0; size < whole.size(); size += size < 80 ? 1 : 13) {
            test::put(folder / "cut.hdr", whole.substr(0, size));
            EXPECT_EQ(error_of([&] { read_environment_image(folder / "cut.hdr"); }).kind(), ErrorKind::input) << size;
        }
        for (std::size_t at = 0; at < whole.size(); at += at < 80 ? 1 : 5)
            for (int bit = 0; bit < 8; ++bit) {
                std::string flipped = whole;
                flipped[at] = static_cast<char>(flipped[at] ^ (1 << bit));
                test::put(folder / "flip.hdr", flipped);
                try {
                    EXPECT_FALSE(read_environment_image(folder / "flip.hdr").rgb.empty());
                } catch (const Error& e) {
                    EXPECT_EQ(e.kind(), ErrorKind::input) << e.line();
                }
            }
    }
}

TEST(EnvironmentImageTest, SaysWhatIsWrongWithRadiance) {
    const Folder folder;
    const auto said = [&](const std::string& bytes) {
        test::put(folder / "a.hdr", bytes);
        return error_of([&] { read_environment_image(folder / "a.hdr"); }).line();
    };
    EXPECT_THAT(said("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n0000"), HasSubstr("pixel format"));
    EXPECT_THAT(said("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -X 1\n0000"), HasSubstr("resolution line '+X 1 -X 1'"));
    EXPECT_THAT(said("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1 x\n0000"), HasSubstr("resolution line"));
    EXPECT_THAT(said("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 8\n"), HasSubstr("8 x 0 pixels"));
    EXPECT_THAT(said("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999 +X 99999\n0000"), HasSubstr("99999 x 99999"));
    EXPECT_THAT(said("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16384 +X 16384\n0000"), HasSubstr("bytes or more are missing"));
    const std::string start = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n" + std::string("\2\2\0\10", 4);
    EXPECT_THAT(said(start + std::string(100, '\0')), HasSubstr("a run of 0 pixels"));
    EXPECT_THAT(said(start + std::string("\x89", 1) + std::string(100, '\0')), HasSubstr("a run of 9 pixels"));
    EXPECT_THAT(said("\x89PNG\r\n"), HasSubstr("a picture of 8 bits"));
    EXPECT_THAT(said(""), HasSubstr("no picture that clvr reads: OpenEXR, Radiance .hdr"));
    EXPECT_THAT(error_of([&] { read_environment_image(folder / "none.hdr"); }).line(), HasSubstr("No such file"));
}

TEST(EnvironmentImageTest, ReadsOpenExr) {
    const Folder folder;
    Frame frame = test::noise(4, 2, {"R", "G", "B", "A"});
    for (auto& channel : frame.channels)
        for (float& x : channel.second) x += 1;
    write_exr(frame, folder / "sky"); // the bytes decide, not the name
    const RgbImage image = read_environment_image(folder / "sky");
    for (int i = 0; i < 8; ++i) EXPECT_EQ(image.rgb[3 * i + 1], frame.at("G")[i]);
    write_exr(test::noise(4, 2, {"R", "G"}), folder / "b.exr");
    EXPECT_THAT(error_of([&] { read_environment_image(folder / "b.exr"); }).line(), HasSubstr("no channel B"));
}

TEST(EnvironmentImageTest, IsWhatItsFileShows) {
    const Folder folder;
    Frame frame = test::noise(4, 2, {"R", "G", "B"});
    for (auto& channel : frame.channels)
        for (float& x : channel.second) x += 1;
    frame.display = Region{-1, 0, 32, 16};
    write_exr(frame, folder / "part.exr");
    const RgbImage image = read_environment_image(folder / "part.exr");
    ASSERT_EQ(std::make_pair(image.width, image.height), std::make_pair(32, 16));
    EXPECT_EQ(image.rgb[0], 0);
    EXPECT_EQ(image.rgb[3 * (32 + 1)], frame.at("R")[4]);
    frame.display = Region{0, 0, 64, 16};
    write_exr(frame, folder / "spot.exr");
    EXPECT_THAT(error_of([&] { read_environment_image(folder / "spot.exr"); }).line(), HasSubstr("64 x 16"));
    frame.display = Region{0, 0, 1 << 25, 1}; // 439 bytes took a minute
    write_exr(frame, folder / "line.exr");
    EXPECT_THAT(error_of([&] { read_environment_image(folder / "line.exr"); }).line(), HasSubstr("33554432 x 1"));
}

TEST(EnvironmentImageTest, NamesThePixelThatIsNoRadiance) {
    const Folder folder;
    for (float bad : {-0.5f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Frame frame;
        frame.width = 5;
        frame.height = 3;
        for (const char* c : {"R", "G", "B"}) frame.channel(c);
        frame.channel("G")[11] = bad;
        write_exr(frame, folder / "a.exr");
        EXPECT_THAT(error_of([&] { read_environment_image(folder / "a.exr"); }).line(), HasSubstr("at pixel (1, 2)"));
    }
}

} // namespace
} // namespace clvr
