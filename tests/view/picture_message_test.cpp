// A picture as the page gets it.
#include "host/io/picture/frame_file.hpp"
#include "host/view/picture_message.hpp"
#include "tests/io/frames.hpp"

#include <cstring>

namespace clvr::view {
namespace {

LivePicture picture(Phase phase, int components) {
    LivePicture p;
    p.number = 0x100000007, p.generation = 0x123456789abc, p.phase = phase, p.divider = 3, p.samples = 16;
    p.pixels = {40, 30, components, std::vector<unsigned char>(40 * 30 * static_cast<std::size_t>(components), 200)};
    return p;
}

template <class T>
T at(const std::string& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

Frame decoded(const std::string& message, Frame (*read)(const std::string&)) {
    const test::Folder folder;
    test::put(folder / "a", message.substr(32));
    return read(folder / "a");
}

TEST(PictureMessage, BeginsWithItsHeader) {
    const EncodedPicture e = encode(picture(Phase::accumulating, 3), 120, 90);
    EXPECT_EQ(e.number, 7u);
    EXPECT_EQ(e.bytes.substr(0, 4), "CLVR");
    EXPECT_EQ(at<std::uint32_t>(e.bytes, 4), 7u);
    EXPECT_EQ(at<std::uint64_t>(e.bytes, 8), 0x123456789abcu);
    EXPECT_EQ(at<std::uint32_t>(e.bytes, 16), 16u);
    EXPECT_EQ(at<std::uint16_t>(e.bytes, 20), 40);
    EXPECT_EQ(at<std::uint16_t>(e.bytes, 22), 30);
    EXPECT_EQ(at<std::uint16_t>(e.bytes, 24), 120);
    EXPECT_EQ(at<std::uint16_t>(e.bytes, 26), 90);
    EXPECT_EQ(e.bytes.substr(28, 4), std::string({3, 0, 1, 0}));
}

TEST(PictureMessage, IsJpegUntilItIsSettled) {
    const EncodedPicture moving = encode(picture(Phase::moving, 3), 120, 90), settled = encode(picture(Phase::settled, 4), 40, 30);
    EXPECT_EQ(moving.bytes.substr(29, 2), std::string({0, 0}));
    EXPECT_EQ(settled.bytes.substr(29, 2), std::string({1, 2}));
    EXPECT_EQ(decoded(moving.bytes, read_jpeg).width, 40);
    const Frame png = decoded(settled.bytes, read_png);
    EXPECT_EQ(png.width, 40);
    EXPECT_TRUE(png.has("A"));
}

TEST(PictureMessage, SettledHasThePixelsThatWereDrawn) {
    LivePicture p = picture(Phase::settled, 4);
    for (std::size_t i = 0; i < p.pixels.values.size(); ++i) p.pixels.values[i] = static_cast<unsigned char>(i * 7919 >> 3);
    const Frame drawn = frame_of(p.pixels), sent = decoded(encode(p, 40, 30).bytes, read_png);
    EXPECT_EQ(sent.channels, drawn.channels);
}

TEST(PictureMessage, JpegLiesOverBlackAsABrowserMixes) {
    LivePicture p = picture(Phase::accumulating, 4);
    for (std::size_t i = 3; i < p.pixels.values.size(); i += 4) p.pixels.values[i] = 51; // a fifth
    const Frame frame = decoded(encode(p, 40, 30).bytes, read_jpeg);
    DisplayPixels forty{1, 1, 3, {40, 40, 40}};
    EXPECT_NEAR(frame.at("R")[0], frame_of(forty).at("R")[0], 0.003);
}

} // namespace
} // namespace clvr::view
