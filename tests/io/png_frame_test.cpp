// Pictures as PNG: tone maps, alpha, and the check of the output's place.
#include "host/io/picture/frame_file.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include <cmath>
#include <fstream>
#include <limits>

namespace clvr {
namespace {

using test::error_of;
using test::Folder;
using ::testing::HasSubstr;

struct Picture {
    int width = 0, height = 0, components = 0;
    std::vector<unsigned char> values;
    std::vector<int> at(int i) const { return {values.begin() + i * components, values.begin() + (i + 1) * components}; }
};

Picture read_png(const std::string& path) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str())) << image.message;
    Picture picture;
    picture.components = image.format & PNG_FORMAT_FLAG_ALPHA ? 4 : 3;
    EXPECT_EQ(image.format & PNG_FORMAT_FLAG_LINEAR, 0u) << "8 bits";
    image.format = picture.components == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    picture.width = static_cast<int>(image.width);
    picture.height = static_cast<int>(image.height);
    picture.values.resize(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, picture.values.data(), 0, nullptr)) << image.message;
    return picture;
}

struct Pixel {
    float r, g, b, a;
};

/// Writes the pixels as one line and reads the picture.
Picture developed(const std::vector<Pixel>& pixels, const Tonemap& tonemap) {
    const Folder folder;
    Frame frame;
    frame.width = static_cast<int>(pixels.size());
    frame.height = 1;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        frame.channel("R")[i] = pixels[i].r;
        frame.channel("G")[i] = pixels[i].g;
        frame.channel("B")[i] = pixels[i].b;
        frame.channel("A")[i] = pixels[i].a;
    }
    write_png(frame, tonemap, folder / "a.png");
    EXPECT_EQ(folder.entries(), 1u);
    return read_png(folder / "a.png");
}

int grey(float radiance, const Tonemap& tonemap) { return developed({{radiance, radiance, radiance, 1}}, tonemap).values[0]; }

int srgb_byte(double x) { return static_cast<int>(std::lrint(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055))); }

TEST(PngFrameTest, WithoutToneMapItIsSrgb) {
    const std::vector<float> values{0, 0.001f, 0.01f, 0.18f, 0.5f, 0.99f, 1};
    std::vector<Pixel> pixels{{4, 4, 4, 1}};
    for (float x : values) pixels.push_back({x, x, x, 1});
    const Picture p = developed(pixels, {"none", 0});
    EXPECT_EQ(p.at(0)[0], 255);
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(p.at(static_cast<int>(i) + 1)[0], srgb_byte(values[i])) << values[i];
}

TEST(PngFrameTest, ExposureIsInStops) {
    EXPECT_EQ(grey(0.1f, {"none", 2}), srgb_byte(0.4));
    EXPECT_EQ(grey(0.8f, {"none", -3}), srgb_byte(0.1));
}

TEST(PngFrameTest, CurvesRiseAndStayBelowWhite) {
    std::vector<Pixel> ramp;
    for (float x = 0; x < 8; x += 0.01f) ramp.push_back({x, x, x, 1});
    for (const char* name : tonemap_names) {
        const Picture p = developed(ramp, {name, 0});
        for (int i = 1; i < p.width; ++i) EXPECT_GE(p.at(i)[0], p.at(i - 1)[0]) << name << " " << i;
    }
    EXPECT_NEAR(grey(1, {"filmic", 0}), srgb_byte(0.9), 1) << "white that faces the key is near white";
    EXPECT_LT(grey(3, {"filmic", 0}), 255);
    EXPECT_EQ(grey(1, {"reinhard", 0}), srgb_byte(0.5));
    EXPECT_EQ(grey(0.25f, {"filmic", 0}), srgb_byte(1.3 * 0.25));
}

TEST(PngFrameTest, FilmicKeepsTheHue) {
    // Rolled off, but the same ratios of linear components up to the small share of white.
    const auto c = developed({{1.2f, 0.6f, 0.3f, 1}}, {"filmic", 0}).at(0);
    const auto linear = [](int v) { return std::pow((v / 255.0 + 0.055) / 1.055, 2.4); };
    EXPECT_NEAR(linear(c[1]) / linear(c[0]), 0.5, 0.06);
    EXPECT_NEAR(linear(c[2]) / linear(c[0]), 0.25, 0.09);
    const auto far = developed({{1e4f, 1e3f, 1e3f, 1}}, {"filmic", 0}).at(0);
    EXPECT_GT(far[1], 240) << "far highlights go to white";
}

TEST(PngFrameTest, AlphaIsStraight) {
    // Half covered by a surface of radiance 0.4: the colour is that of the surface, the alpha a half.
    const Picture p =
        developed({{0.2f, 0.1f, 0.05f, 0.5f}, {0.4f, 0.2f, 0.1f, 1}, {0, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.001f}}, {"filmic", 0});
    ASSERT_EQ(p.components, 4);
    const auto half = p.at(0), full = p.at(1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(half[c], full[c], 1);
    EXPECT_EQ(half[3], 128);
    EXPECT_EQ(full[3], 255);
    EXPECT_EQ(p.at(2), (std::vector<int>{0, 0, 0, 0}));
    EXPECT_EQ(p.at(3), (std::vector<int>{0, 0, 0, 0})) << "what rounds to nothing is nothing";
}

TEST(PngFrameTest, AnOpaquePictureHasNoAlpha) {
    EXPECT_EQ(developed({{0.1f, 0.2f, 0.3f, 1}, {0, 0, 0, 1}}, {"filmic", 0}).components, 3);
    const Folder folder;
    write_png(test::noise(6, 5, {"R", "G", "B"}), {}, folder / "a.png");
    const Picture p = read_png(folder / "a.png");
    EXPECT_EQ(p.components, 3);
    EXPECT_EQ(p.width, 6);
    EXPECT_EQ(p.height, 5);
}

TEST(PngFrameTest, WildValuesMakeAPicture) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const char* name : tonemap_names) {
        const Picture p = developed({{nan, -1, inf, 1}, {inf, inf, inf, 0.5f}, {1, 1, 1, nan}, {1e38f, 0, 0, 1e-30f}}, {name, 60});
        EXPECT_GT(p.at(0)[2], 200) << name;
        EXPECT_GT(p.at(1)[0], 200) << name;
        EXPECT_EQ(p.at(2)[3], 0) << name;
    }
    EXPECT_EQ(developed({{nan, -1, 0.5f, 1}}, {"none", 0}).at(0), (std::vector<int>{0, 0, srgb_byte(0.5)}));
}

TEST(PngFrameTest, Refusals) {
    const Folder folder;
    const Frame frame = test::noise(2, 2, {"R", "G", "B"});
    EXPECT_EQ(error_of([&] { write_png(frame, {"sepia", 0}, folder / "a.png"); }).kind(), ErrorKind::usage);
    EXPECT_THAT(error_of([&] { write_png(test::noise(2, 2, {"R", "albedo.G"}), {}, folder / "a.png"); }).line(), HasSubstr("no channel G"));
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(FramePathTest, AGoodPlaceIsLeftAsItWas) {
    const Folder folder;
    check_frame_path(folder / "a.exr");
    check_frame_path(folder / "b.PNG");
    check_frame_path(folder / "b.JPG");
    check_frame_path(folder / "b.jpeg");
    check_frame_path(folder / "b.Exr");
    EXPECT_EQ(folder.entries(), 0u);
    test::put(folder / "c.png", "old");
    check_frame_path(folder / "c.png");
    EXPECT_EQ(test::bytes_of(folder / "c.png"), "old");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(FramePathTest, BadPlacesAreFoundBeforeRendering) {
    const Folder folder;
    std::filesystem::create_directory(folder / "d.png");
    EXPECT_THAT(error_of([&] { check_frame_path(folder / "d.png"); }).line(), HasSubstr("is a folder"));
    EXPECT_THAT(error_of([&] { check_frame_path(folder / "no/such/a.png"); }).line(), HasSubstr("there is no folder"));
    EXPECT_THAT(error_of([&] { check_frame_path(folder / "a.tif"); }).line(),
                HasSubstr("'.tif'; expected .png or .jpg (a picture) or .exr"));
    EXPECT_THAT(error_of([&] { check_frame_path(folder / "png"); }).line(), HasSubstr("ending ''"));
    test::put(folder / "file", "x");
    EXPECT_THAT(error_of([&] { check_frame_path(folder / "file/a.png"); }).line(), HasSubstr("no folder"));
    EXPECT_THAT(error_of([&] { check_frame_path(folder / (std::string(300, 'a') + ".png")); }).line(), HasSubstr("longer than"));
    EXPECT_THAT(error_of([&] { check_frame_path("/proc/clvr.png"); }).line(), HasSubstr("cannot write here")); // for root, too
    EXPECT_EQ(folder.entries(), 2u);
}

TEST(PngFrameTest, ReadsBackAsLinearLight) {
    const Folder folder;
    Frame f;
    f.width = 3, f.height = 1;
    f.channels = {{"R", {0.5f, 0.25f, 0}}, {"G", {1, 0, 0}}, {"B", {0.1f, 0.5f, 0}}, {"A", {1, 0.5f, 0}}};
    write_png(f, {"none", 0}, folder / "a.png");
    const Frame back = read_picture(folder / "a.png");
    ASSERT_EQ(back.width, 3);
    for (const auto& [name, values] : f.channels)
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back.at(name)[i], values[i], 0.005) << name << i;
    f.channels.erase("A");
    write_png(f, {"none", 0}, folder / "b.png");
    EXPECT_FALSE(clvr::read_png(folder / "b.png").has("A"));
}

TEST(PngFrameTest, IsOpaqueOverABackground) {
    const Folder folder;
    Frame f;
    f.width = 3, f.height = 1;
    f.channels = {
        {"R", {0.5f, 0.25f, 0.75f}}, {"G", {1, 0, 0}}, {"B", {0.1f, 0.5f, 0}}, {"A", {1, 0.5f, 0}}, {"background.R", {0, 0, 0.75f}}};
    write_png(f, {"none", 0}, folder / "a.png");
    const Frame back = read_picture(folder / "a.png");
    EXPECT_FALSE(back.has("A"));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back.at("R")[i], f.at("R")[i], 0.005) << i;
}

TEST(PngFrameTest, RefusesWhatIsNone) {
    const Folder folder;
    std::ofstream(folder / "a.png") << "no picture";
    EXPECT_THROW(clvr::read_png(folder / "a.png"), Error);
    EXPECT_THROW(clvr::read_png(folder / "none.png"), Error);
    Frame f;
    f.width = f.height = 16;
    for (const char* c : {"R", "G", "B"}) f.channel(c)[40] = 1;
    const std::vector<unsigned char> whole = encode_png(f, {"none", 0});
    std::ofstream(folder / "c.png", std::ios::binary)
        .write(reinterpret_cast<const char*>(whole.data()), static_cast<std::streamsize>(whole.size()) * 2 / 3);
    EXPECT_THROW(clvr::read_png(folder / "c.png"), Error);
}

} // namespace
} // namespace clvr
