// Frames to OpenEXR and back, and files that are none.
#include "host/io/picture/frame_file.hpp"
#include "tests/io/frames.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <half.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace clvr {
namespace {

using test::error_of;
using test::Folder;
using ::testing::HasSubstr;

const std::vector<std::string> all_channels{"R",          "G",          "B",           "A",        "albedo.R", "albedo.G",
                                            "albedo.B",   "normal.X",   "normal.Y",    "normal.Z", "depth.Z",  "depth.deviation",
                                            "depth.half", "opacity.A",  "noisy.R",     "noisy.G",  "noisy.B",  "variance.R",
                                            "variance.G", "variance.B", "background.R"};

TEST(ExrFrameTest, RoundTripKeepsEveryBitAndAttribute) {
    const Folder folder;
    Frame frame = test::noise(37, 21, all_channels);
    frame.channel("R")[0] = -0.0f;
    frame.channel("R")[1] = std::numeric_limits<float>::denorm_min();
    frame.channel("R")[2] = std::numeric_limits<float>::infinity();
    frame.attributes = {{"clvr.seed", "18446744073709551615"}, {"clvr.scene", "{\"a\": 1}\n"}, {"clvr.note", "\xc3\xbc"}};
    write_exr(frame, folder / "a.exr");
    const Frame back = read_exr(folder / "a.exr");
    EXPECT_EQ(pixel_hash(back), pixel_hash(frame));
    EXPECT_EQ(back.attributes, frame.attributes);
    const Frame outline = exr_outline(folder / "a.exr");
    EXPECT_EQ(outline.window(), frame.window());
    EXPECT_EQ(outline.attributes, frame.attributes);
    ASSERT_EQ(outline.channels.size(), frame.channels.size());
    for (const auto& [name, values] : outline.channels) EXPECT_TRUE(frame.has(name) && values.empty()) << name;
    EXPECT_EQ(folder.entries(), 1u) << "no temporary file is left";
}

TEST(ExrFrameTest, TheSameFrameMakesTheSameFile) {
    const Folder folder;
    const Frame frame = test::noise(64, 64, {"R", "G", "B"});
    write_exr(frame, folder / "a.exr");
    write_exr(frame, folder / "b.exr");
    EXPECT_EQ(test::bytes_of(folder / "a.exr"), test::bytes_of(folder / "b.exr"));
}

TEST(ExrFrameTest, PixelHashSeesEveryBitButNoAttribute) {
    Frame frame = test::noise(5, 4, {"A", "R"});
    const std::string hash = pixel_hash(frame);
    EXPECT_EQ(hash.size(), 64u);
    frame.attributes["clvr.device"] = "another";
    EXPECT_EQ(pixel_hash(frame), hash);
    frame.channel("R")[19] = std::nextafter(frame.at("R")[19], 9.0f);
    EXPECT_NE(pixel_hash(frame), hash);
    Frame turned = test::noise(4, 5, {"A", "R"}), renamed = test::noise(5, 4, {"A", "G"});
    EXPECT_NE(pixel_hash(turned), hash);
    EXPECT_NE(pixel_hash(renamed), hash);
}

/// An EXR as other programs write it: half, uint and float, a data window away from 0, tiles.
void write_foreign(const std::string& path, bool tiled) {
    const Imath::Box2i window({-3, 5}, {6, 11});
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
    header.compression() = Imf::PIZ_COMPRESSION;
    header.channels().insert("B", Imf::Channel(Imf::HALF));
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.channels().insert("id", Imf::Channel(Imf::UINT));
    header.insert("owner", Imf::StringAttribute("somebody"));
    std::vector<float> r(70);
    std::vector<half> b(70);
    std::vector<unsigned> id(70);
    for (int i = 0; i < 70; ++i)
        r[i] = 0.1f * static_cast<float>(i), b[i] = half(0.25f * static_cast<float>(i)), id[i] = static_cast<unsigned>(i);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, r.data(), window));
    buffer.insert("B", Imf::Slice::Make(Imf::HALF, b.data(), window));
    buffer.insert("id", Imf::Slice::Make(Imf::UINT, id.data(), window));
    if (tiled) {
        header.setTileDescription(Imf::TileDescription(4, 4));
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(7);
    }
}

TEST(ExrFrameTest, ReadsHalfUintTilesAndOffsetWindows) {
    const Folder folder;
    for (bool tiled : {false, true}) {
        write_foreign(folder / "f.exr", tiled);
        const Frame frame = read_exr(folder / "f.exr");
        EXPECT_EQ(frame.width, 10);
        EXPECT_EQ(frame.height, 7);
        ASSERT_TRUE(frame.has("R") && frame.has("B") && frame.has("id"));
        for (int i = 0; i < 70; ++i) {
            EXPECT_EQ(frame.at("R")[i], 0.1f * static_cast<float>(i));
            EXPECT_EQ(frame.at("B")[i], 0.25f * static_cast<float>(i));
            EXPECT_EQ(frame.at("id")[i], static_cast<float>(i));
        }
        EXPECT_EQ(frame.attributes, (std::map<std::string, std::string>{{"owner", "somebody"}}));
    }
}

/// Lines of 1 and of 16 a block, packed or not, of all types, not from 0; one more channel than is asked for.
TEST(ExrFrameTest, ReadsLinesThatOpenExrPacked) {
    const Folder folder;
    const Imath::Box2i window({-2, 3}, {18, 40}); // 21 x 38: the last block is a short one
    const std::size_t pixels = 21 * 38;
    std::vector<float> r(pixels);
    std::vector<half> g(pixels);
    std::vector<unsigned> id(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        r[i] = std::sin(static_cast<float>(i)), g[i] = half(i < 200 ? 0.0f : 0.01f * static_cast<float>(i)),
        id[i] = static_cast<unsigned>(i) << 20;
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
        for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
            Imf::Header header(window, window);
            header.compression() = compression;
            header.lineOrder() = order;
            header.channels().insert("R", Imf::Channel(Imf::FLOAT));
            header.channels().insert("G", Imf::Channel(Imf::HALF));
            header.channels().insert("id", Imf::Channel(Imf::UINT));
            Imf::FrameBuffer buffer;
            buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, r.data(), window));
            buffer.insert("G", Imf::Slice::Make(Imf::HALF, g.data(), window));
            buffer.insert("id", Imf::Slice::Make(Imf::UINT, id.data(), window));
            {
                Imf::OutputFile file((folder / "a.exr").c_str(), header);
                file.setFrameBuffer(buffer);
                file.writePixels(38);
            }
            const Frame frame = read_exr(folder / "a.exr");
            ASSERT_EQ(frame.pixels(), pixels);
            for (std::size_t i = 0; i < pixels; ++i) {
                ASSERT_EQ(frame.at("R")[i], r[i]);
                ASSERT_EQ(frame.at("G")[i], static_cast<float>(g[i]));
                ASSERT_EQ(frame.at("id")[i], static_cast<float>(id[i]));
            }
        }
}

TEST(ExrFrameTest, OpenExrReadsWhatIsWritten) {
    const Folder folder;
    const std::string long_name = "a.channel.with.a.name.of.more.than.31.characters";
    Frame frame = test::noise(33, 50, {"A", "B", "G", "R", long_name});
    for (std::size_t i = 0; i < 900; ++i) frame.channel("B")[i] = 0; // some blocks pack, those of noise do not
    frame.x = -7, frame.y = 11;
    write_exr(frame, folder / "a.exr");
    Imf::InputFile file((folder / "a.exr").c_str());
    const Imath::Box2i window = file.header().dataWindow();
    EXPECT_EQ(window, Imath::Box2i({-7, 11}, {25, 60}));
    EXPECT_TRUE(file.isComplete());
    for (const auto& [name, values] : frame.channels) {
        std::vector<float> read(frame.pixels());
        Imf::FrameBuffer buffer;
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, read.data(), window));
        file.setFrameBuffer(buffer);
        file.readPixels(window.min.y, window.max.y);
        EXPECT_EQ(read, values) << name;
    }
}

TEST(ExrFrameTest, TruncatedAndFlippedFilesAreErrorsOrPictures) {
    const Folder folder;
    write_exr(test::noise(33, 40, {"R", "G", "B", "A"}), folder / "a.exr");
    const std::string whole = test::bytes_of(folder / "a.exr");
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97) {
        test::put(folder / "cut.exr", whole.substr(0, size));
        const Error e = error_of([&] { read_exr(folder / "cut.exr"); });
        EXPECT_EQ(e.kind(), ErrorKind::input) << size << ": " << e.line();
    }
    // A flipped bit may hit pixels or a name and stay unseen, but never more than an Error comes out.
    for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 500) {
        std::string flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 0x40);
        test::put(folder / "flip.exr", flipped);
        try {
            EXPECT_GT(read_exr(folder / "flip.exr").pixels(), 0u);
        } catch (const Error& e) {
            EXPECT_NE(e.kind(), ErrorKind::internal) << e.line();
        }
    }
}

TEST(ExrFrameTest, AHeaderThatPromisesTooMuchFailsBeforeItIsAllocated) {
    const Folder folder;
    write_exr(test::noise(8, 8, {"R"}), folder / "a.exr");
    std::string bytes = test::bytes_of(folder / "a.exr");
    const std::size_t window = bytes.find("dataWindow");
    ASSERT_NE(window, std::string::npos);
    const std::size_t high = window + std::strlen("dataWindow") + 1 + std::strlen("box2i") + 1 + 4 + 8;
    const auto with_size = [&](std::int32_t last_x, std::int32_t last_y) {
        std::memcpy(&bytes[high], &last_x, 4);
        std::memcpy(&bytes[high + 4], &last_y, 4);
        test::put(folder / "b.exr", bytes);
        return error_of([&] { read_exr(folder / "b.exr"); }).line();
    };
    EXPECT_THAT(with_size(9999999, 9999999), HasSubstr("b.exr"));
    EXPECT_THAT(with_size(16383, 16383), HasSubstr("b.exr"));
    EXPECT_THAT(with_size(-5, 7), HasSubstr("b.exr"));
}

TEST(ExrFrameTest, AnAttributeLongerThanTheFileIsRefused) {
    const Folder folder;
    Frame frame = test::noise(8, 8, {"R"});
    frame.attributes["clvr.note"] = "short";
    write_exr(frame, folder / "a.exr");
    std::string bytes = test::bytes_of(folder / "a.exr");
    const std::size_t size = bytes.find("clvr.note") + std::strlen("clvr.note") + 1 + std::strlen("string") + 1;
    bytes[size + 3] = 0x40; // 1 GiB
    test::put(folder / "b.exr", bytes);
    EXPECT_THAT(error_of([&] { read_exr(folder / "b.exr"); }).line(),
                HasSubstr("attribute clvr.note has 1073741829 bytes, more than the file"));
}

TEST(ExrFrameTest, WhatIsNoExrIsNamed) {
    const Folder folder;
    EXPECT_THAT(error_of([&] { read_exr(folder / "none.exr"); }).line(), HasSubstr("No such file"));
    EXPECT_THAT(error_of([&] { read_exr(folder / "."); }).line(), HasSubstr("folder"));
    test::put(folder / "empty.exr", "");
    test::put(folder / "text.exr", "a text, not a picture");
    for (const char* name : {"empty.exr", "text.exr"}) {
        const Error e = error_of([&] { read_exr(folder / name); });
        EXPECT_EQ(e.kind(), ErrorKind::input);
        EXPECT_THAT(e.line(), HasSubstr(name));
    }
}

TEST(ExrFrameTest, AFailedWriteLeavesNothing) {
    const Folder folder;
    const Error e = error_of([&] { write_exr(test::noise(4, 4, {"R"}), folder / "absent/a.exr"); });
    EXPECT_EQ(e.kind(), ErrorKind::input);
    EXPECT_THAT(e.line(), HasSubstr("there is no folder"));
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(ExrFrameTest, AnAttributeWhoseSizeIsNotTrueIsRefusedBeforeOpenExrBelievesIt) {
    const test::Folder folder;
    write_exr(test::noise(3, 2, {"R", "G", "B"}), folder / "a.exr");
    const std::string sound = test::bytes_of(folder / "a.exr");
    for (const std::string& name : {std::string("channels\0chlist\0", 16), std::string("dataWindow\0box2i\0", 17)}) {
        std::string damaged = sound;
        damaged.at(sound.find(name) + name.size()) ^= 1; // the size stands behind name and type
        test::put(folder / "b.exr", damaged);
        EXPECT_THAT(test::error_of([&] { read_exr(folder / "b.exr"); }).line(), ::testing::HasSubstr("its header says"));
    }
}

} // namespace
} // namespace clvr
