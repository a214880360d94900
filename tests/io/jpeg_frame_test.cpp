// Pictures as JPEG, and which kind of picture a file is.
#include "host/io/picture/frame_file.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace clvr {
namespace {

using test::error_of;
using test::Folder;
using ::testing::HasSubstr;

Frame ramp() {
    Frame frame;
    frame.width = 48, frame.height = 32;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x) {
            const std::size_t i = static_cast<std::size_t>(48 * y + x);
            frame.channel("R")[i] = static_cast<float>(x) / 64;
            frame.channel("G")[i] = static_cast<float>(y) / 32;
            frame.channel("B")[i] = 0.25f;
        }
    return frame;
}

TEST(JpegFrameTest, ReadsBackAsLinearLight) {
    const Folder folder;
    const Frame frame = ramp();
    write_frame(frame, {"none", 0}, folder / "a.JPG");
    EXPECT_EQ(folder.entries(), 1u);
    const Frame back = read_picture(folder / "a.JPG");
    ASSERT_EQ(back.window(), frame.window());
    EXPECT_FALSE(back.has("A"));
    for (const char* c : {"R", "G", "B"})
        for (std::size_t i = 0; i < frame.pixels(); ++i) {
            const double a = std::pow(frame.at(c)[i], 1 / 2.2), b = std::pow(back.at(c)[i], 1 / 2.2);
            ASSERT_NEAR(a, b, 0.04) << c << i;
        }
    write_frame(frame, {"none", 0}, folder / "b.jpeg");
    EXPECT_EQ(test::bytes_of(folder / "a.JPG"), test::bytes_of(folder / "b.jpeg")) << "the same bits every time";
}

TEST(JpegFrameTest, LiesOverBlackInLinearLight) {
    const Folder folder;
    Frame frame;
    frame.width = frame.height = 16;
    for (const char* c : {"R", "G", "B"}) frame.channel(c).assign(256, 0.4f); // straight 0.8
    frame.channel("A").assign(256, 0.5f);
    write_jpeg(frame, {"none", 0}, folder / "a.jpg");
    Frame back = read_jpeg(folder / "a.jpg");
    for (const float r : back.at("R")) ASSERT_NEAR(r, 0.4, 0.01);
    frame.display = Region{-16, 0, 32, 16}; // the left half is outside
    write_jpeg(frame, {"none", 0}, folder / "b.jpg");
    back = read_jpeg(folder / "b.jpg");
    ASSERT_EQ(back.width, 32);
    EXPECT_NEAR(back.at("R")[2], 0, 0.01);
    EXPECT_NEAR(back.at("R")[29], 0.4, 0.01);
}

TEST(JpegFrameTest, RefusesWhatIsNone) {
    const Folder folder;
    write_jpeg(ramp(), {}, folder / "a.jpg");
    const std::string whole = test::bytes_of(folder / "a.jpg");
    for (std::size_t size = 3; size < whole.size(); size += 1 + whole.size() / 50) {
        test::put(folder / "cut.jpg", whole.substr(0, size));
        EXPECT_EQ(error_of([&] { read_picture(folder / "cut.jpg"); }).kind(), ErrorKind::input) << size;
    }
    for (std::size_t at = 3; at < whole.size(); at += 1 + whole.size() / 300) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 0x20);
        test::put(folder / "flip.jpg", flipped);
        try {
            EXPECT_GT(read_picture(folder / "flip.jpg").pixels(), 0u);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input) << e.line();
        }
    }
    Frame wide;
    wide.width = 65501, wide.height = 1;
    for (const char* c : {"R", "G", "B"}) wide.channel(c);
    EXPECT_THAT(error_of([&] { write_jpeg(wide, {}, folder / "w.jpg"); }).line(), HasSubstr("65501 x 1 pixels are too many"));
    EXPECT_THAT(error_of([&] { write_jpeg(test::noise(2, 2, {"R"}), {}, folder / "w.jpg"); }).line(), HasSubstr("no channel G"));
}

TEST(PictureFormatTest, BytesDecide) {
    const Folder folder;
    write_png(ramp(), {}, folder / "a.exr");
    write_exr(ramp(), folder / "b.png");
    write_jpeg(ramp(), {}, folder / "c.hdr");
    EXPECT_EQ(picture_format(folder / "a.exr"), PictureFormat::png);
    EXPECT_EQ(picture_format(folder / "b.png"), PictureFormat::exr);
    EXPECT_EQ(picture_format(folder / "c.hdr"), PictureFormat::jpeg);
    EXPECT_EQ(pixel_hash(read_picture(folder / "b.png")), pixel_hash(ramp()));
    test::put(folder / "text.png", "a text");
    EXPECT_THAT(error_of([&] { read_picture(folder / "text.png"); }).line(), HasSubstr("no picture that clvr reads"));
}

} // namespace
} // namespace clvr
