// OpenEXR files of several parts, windows and views, and of luminance and chroma.
#include "host/io/picture/exr_names.hpp"
#include "host/io/picture/frame_file.hpp"
#include "tests/io/exr_writers.hpp"
#include "tests/io/frames.hpp"

#include <ImfChromaticitiesAttribute.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfInputFile.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>

namespace clvr {
namespace {

using test::error_of;
using test::FloatPart;
using test::Folder;
using test::part_value;
using test::write_parts;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Imath::Box2i whole{{0, 0}, {3, 2}};

std::vector<std::string> channels_of(const Frame& frame) {
    std::vector<std::string> names;
    for (const auto& [name, values] : frame.channels) names.push_back(name);
    return names;
}

TEST(ExrPartsTest, PassesInPartsAreJoined) {
    const Folder folder;
    // beauty by its name though not first; a layered name stays; a plain one gets the part's
    const std::vector<FloatPart> parts{{"depth", "", {"Z"}, whole, 1000},
                                       {"rgba", "", {"A", "B", "G", "R"}, whole, 2000},
                                       {"albedo", "", {"B", "G", "R"}, whole, 3000},
                                       {"N", "", {"normal.X", "normal.Y", "normal.Z"}, whole, 4000}};
    write_parts(folder / "a.exr", parts, whole);
    const Frame frame = read_exr(folder / "a.exr");
    EXPECT_THAT(channels_of(frame),
                ElementsAre("A", "B", "G", "R", "albedo.B", "albedo.G", "albedo.R", "depth.Z", "normal.X", "normal.Y", "normal.Z"));
    EXPECT_THAT(frame.notes, IsEmpty());
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x) {
            const std::size_t i = static_cast<std::size_t>(4 * y + x);
            EXPECT_EQ(frame.at("depth.Z")[i], part_value(parts[0], 0, x, y));
            EXPECT_EQ(frame.at("R")[i], part_value(parts[1], 3, x, y));
            EXPECT_EQ(frame.at("albedo.G")[i], part_value(parts[2], 1, x, y));
            EXPECT_EQ(frame.at("normal.Z")[i], part_value(parts[3], 2, x, y));
        }
}

TEST(ExrPartsTest, NamesOfPartsAndViews) {
    const ExrPart beauty{"ViewLayer.Combined", "", {"R", "G", "B"}}, first{"first", "", {"R", "G", "B"}},
        albedo{"albedo", "", {"R", "G", "B"}};
    // The first coloured part that is no known pass, said; a usual name goes before.
    ExrNames names = frame_names({albedo, first}, {});
    EXPECT_THAT(names.parts[0], ElementsAre("albedo.R", "albedo.G", "albedo.B"));
    EXPECT_THAT(names.parts[1], ElementsAre("R", "G", "B"));
    EXPECT_THAT(names.notes, ElementsAre(HasSubstr("\"first\" is taken as the beauty")));
    names = frame_names({first, beauty}, {});
    EXPECT_THAT(names.parts[0], ElementsAre("first.R", "first.G", "first.B"));
    EXPECT_THAT(names.parts[1], ElementsAre("R", "G", "B"));
    // A single part keeps its names, whatever it is called.
    EXPECT_THAT(frame_names({albedo}, {}).parts[0], ElementsAre("R", "G", "B"));
    // Its own name before the beauty's channels goes.
    EXPECT_THAT(frame_names({{"rgba", "", {"rgba.R", "rgba.G", "rgba.B", "R", "G", "B"}}, albedo}, {}).parts[0],
                ElementsAre("R", "G", "B", "", "", ""));
    // Views of parts, and of channels.
    names = frame_names({{"rgba.left", "left", {"R", "G", "B"}},
                         {"rgba.right", "right", {"R", "G", "B"}},
                         {"albedo.left", "left", {"R"}},
                         {"mask", "", {"A"}}},
                        {});
    EXPECT_THAT(names.parts,
                ElementsAre(ElementsAre("R", "G", "B"), ElementsAre("", "", ""), ElementsAre("albedo.R"), ElementsAre("mask.A")));
    EXPECT_THAT(names.notes, ElementsAre(HasSubstr("left out: right")));
    names = frame_names({{"", "", {"R", "left.G", "right.R", "albedo.left.R", "albedo.right.R", "normal.X"}}}, {"left", "right"});
    EXPECT_THAT(names.parts[0], ElementsAre("R", "G", "", "albedo.R", "", "normal.X"));
    EXPECT_THAT(names.notes, ElementsAre(HasSubstr("several views")));
    EXPECT_THAT(frame_names({{"", "", {"left.R", "right.R"}}}, {}).parts[0], ElementsAre("left.R", "right.R")) << "layers, no views";
}

TEST(ExrPartsTest, DifferentDataWindowsAreJoined) {
    const Folder folder;
    const std::vector<FloatPart> parts{{"rgba", "", {"B", "G", "R"}, {{1, 1}, {3, 2}}, 500}, {"albedo", "", {"R"}, {{-1, 0}, {1, 1}}, 700}};
    write_parts(folder / "a.exr", parts, whole);
    const Frame frame = read_exr(folder / "a.exr");
    EXPECT_EQ(frame.window(), (Region{-1, 0, 5, 3}));
    EXPECT_EQ(frame.shown(), (Region{0, 0, 4, 3}));
    EXPECT_THAT(frame.notes, ElementsAre(HasSubstr("different data windows")));
    for (int y = 0; y < 3; ++y)
        for (int x = -1; x < 4; ++x) {
            const std::size_t i = static_cast<std::size_t>(5 * y + x + 1);
            EXPECT_EQ(frame.at("R")[i], x >= 1 && y >= 1 ? part_value(parts[0], 2, x - 1, y - 1) : 0) << x << y;
            EXPECT_EQ(frame.at("albedo.R")[i], x <= 1 && y <= 1 ? part_value(parts[1], 0, x + 1, y) : 0) << x << y;
        }
    write_parts(folder / "far.exr", {parts[0], {"albedo", "", {"R"}, {{9000, 9000}, {9001, 9001}}}}, whole);
    EXPECT_THAT(error_of([&] { read_exr(folder / "far.exr"); }).line(), HasSubstr("far from one another"));
}

TEST(ExrWindowsTest, BothWindowsAndAttributesOutliveTheFrame) {
    const Folder folder;
    const Imath::Box2i data({8, 6}, {23, 17}), display({0, 0}, {31, 23});
    Imf::Header header(display, data, 2.0f);
    const Imf::Chromaticities wide({0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, {0.3127f, 0.3290f});
    Imf::addChromaticities(header, wide);
    Imath::M44f camera;
    camera[3][1] = 5;
    header.insert("worldToCamera", Imf::M44fAttribute(camera));
    header.insert("owner", Imf::StringAttribute("somebody"));
    header.channels().insert("G", Imf::Channel(Imf::FLOAT));
    std::vector<float> g(16 * 12, 0.5f);
    {
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        Imf::FrameBuffer buffer;
        buffer.insert("G", Imf::Slice::Make(Imf::FLOAT, g.data(), data));
        file.setFrameBuffer(buffer);
        file.writePixels(12);
    }
    const Frame frame = read_exr(folder / "a.exr");
    EXPECT_EQ(frame.window(), (Region{8, 6, 16, 12}));
    EXPECT_EQ(frame.shown(), (Region{0, 0, 32, 24}));
    EXPECT_EQ(frame.pixel_aspect, 2);
    EXPECT_THAT(frame.notes, ElementsAre(HasSubstr("other primaries")));
    write_exr(frame, folder / "b.exr");
    const Imf::InputFile back((folder / "b.exr").c_str());
    EXPECT_EQ(back.header().dataWindow(), data);
    EXPECT_EQ(back.header().displayWindow(), display);
    EXPECT_EQ(back.header().pixelAspectRatio(), 2);
    EXPECT_EQ(Imf::chromaticities(back.header()), wide);
    EXPECT_EQ(back.header().typedAttribute<Imf::M44fAttribute>("worldToCamera").value(), camera);
    EXPECT_EQ(back.header().typedAttribute<Imf::StringAttribute>("owner").value(), "somebody");
}

TEST(ExrWindowsTest, PicturesShowTheDisplayWindow) {
    const Folder folder;
    Frame frame;
    frame.width = 3, frame.height = 2, frame.x = -1, frame.y = 1; // one column beyond the left edge
    frame.display = Region{0, 0, 4, 4};
    frame.channels = {{"R", {1, 0, 1, 1, 1, 0}}, {"G", {0, 1, 1, 0, 0, 1}}, {"B", {0, 0, 0, 0, 0, 0}}};
    write_png(frame, {"none", 0}, folder / "black.png");
    Frame back = read_png(folder / "black.png");
    ASSERT_EQ(back.window(), (Region{0, 0, 4, 4}));
    EXPECT_FALSE(back.has("A"));
    EXPECT_THAT(back.at("R"), ElementsAre(0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0));
    EXPECT_THAT(back.at("G"), ElementsAre(0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0));
    frame.channels["A"] = std::vector<float>(6, 1);
    write_png(frame, {"none", 0}, folder / "clear.png");
    back = read_png(folder / "clear.png");
    ASSERT_TRUE(back.has("A"));
    EXPECT_THAT(back.at("A"), ElementsAre(0, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0));
    frame.display = Region{0, 0, 1 << 20, 1 << 20};
    EXPECT_THAT(error_of([&] { write_png(frame, {}, folder / "c.png"); }).line(), HasSubstr("1048576 x 1048576"));
    frame.display = Region{0, 0, 1 << 25, 1};
    EXPECT_THAT(error_of([&] { write_png(frame, {}, folder / "c.png"); }).line(), HasSubstr("33554432 x 1 pixels"));
}

TEST(ExrKindsTest, LuminanceAndChroma) {
    const Folder folder;
    const int width = 32, height = 16;
    std::vector<Imf::Rgba> pixels(static_cast<std::size_t>(width * height), Imf::Rgba(0.5f, 0.25f, 0.125f, 0.75f));
    for (const auto channels : {Imf::WRITE_YC, Imf::WRITE_YCA}) {
        Imf::RgbaOutputFile file((folder / "yc.exr").c_str(), width, height, channels);
        file.setFrameBuffer(pixels.data(), 1, width);
        file.writePixels(height);
    }
    const Frame frame = read_exr(folder / "yc.exr");
    EXPECT_THAT(channels_of(frame), ElementsAre("A", "B", "G", "R"));
    EXPECT_THAT(frame.notes, ElementsAre(HasSubstr("luminance and chroma")));
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        ASSERT_NEAR(frame.at("R")[i], 0.5, 0.01) << i;
        ASSERT_NEAR(frame.at("G")[i], 0.25, 0.01) << i;
        ASSERT_NEAR(frame.at("B")[i], 0.125, 0.01) << i;
        ASSERT_NEAR(frame.at("A")[i], 0.75, 0.01) << i;
    }
    const std::string bytes = test::bytes_of(folder / "yc.exr");
    test::put(folder / "cut.exr", bytes.substr(0, bytes.size() * 2 / 3));
    EXPECT_EQ(error_of([&] { read_exr(folder / "cut.exr"); }).kind(), ErrorKind::input);
}

TEST(ExrKindsTest, LuminanceAloneIsGrey) {
    const Folder folder;
    write_exr(test::noise(5, 4, {"Y"}), folder / "y.exr");
    const Frame frame = read_exr(folder / "y.exr");
    EXPECT_THAT(channels_of(frame), ElementsAre("B", "G", "R"));
    EXPECT_EQ(frame.at("R"), test::noise(5, 4, {"Y"}).at("Y"));
    EXPECT_EQ(frame.at("B"), frame.at("R"));
    EXPECT_THAT(frame.notes, ElementsAre(HasSubstr("grey")));
}

TEST(ExrKindsTest, OfMipmapsTheLargest) {
    const Folder folder;
    Imf::Header header(20, 12);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
    {
        Imf::TiledOutputFile file((folder / "m.exr").c_str(), header);
        for (int level = 0; level < file.numLevels(); ++level) {
            std::vector<float> values(static_cast<std::size_t>(file.levelWidth(level) * file.levelHeight(level)));
            for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(1000 * level) + static_cast<float>(i);
            Imf::FrameBuffer buffer;
            buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, values.data(), file.dataWindowForLevel(level)));
            file.setFrameBuffer(buffer);
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    }
    const Frame frame = read_exr(folder / "m.exr");
    ASSERT_EQ(frame.pixels(), 240u);
    for (std::size_t i = 0; i < 240; ++i) ASSERT_EQ(frame.at("R")[i], static_cast<float>(i));
}

TEST(ExrKindsTest, DeepPartsAreLeftOut) {
    const Folder folder;
    Imf::Header flat(whole, whole), deep(whole, whole);
    flat.setName("rgba"), flat.setType(Imf::SCANLINEIMAGE);
    deep.setName("deep"), deep.setType(Imf::DEEPSCANLINE);
    deep.compression() = Imf::ZIPS_COMPRESSION;
    for (const char* c : {"R", "G", "B"}) flat.channels().insert(c, Imf::Channel(Imf::FLOAT));
    deep.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    const auto write = [&](const std::string& path, std::vector<Imf::Header> headers) {
        Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
        std::vector<float> values(12, 0.5f);
        for (int p = 0; p < file.parts(); ++p) {
            if (headers[static_cast<std::size_t>(p)].type() == Imf::DEEPSCANLINE) {
                std::vector<unsigned> counts(12, 1);
                std::vector<float*> pointers;
                for (float& v : values) pointers.push_back(&v);
                Imf::DeepFrameBuffer buffer;
                buffer.insertSampleCountSlice(
                    Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), 4 * sizeof(unsigned)));
                buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*), 4 * sizeof(float*),
                                                  sizeof(float)));
                Imf::DeepScanLineOutputPart part(file, p);
                part.setFrameBuffer(buffer);
                part.writePixels(3);
            } else {
                Imf::FrameBuffer buffer;
                for (const char* c : {"R", "G", "B"}) buffer.insert(c, Imf::Slice::Make(Imf::FLOAT, values.data(), whole));
                Imf::OutputPart part(file, p);
                part.setFrameBuffer(buffer);
                part.writePixels(3);
            }
        }
    };
    write(folder / "both.exr", {deep, flat});
    const Frame frame = read_exr(folder / "both.exr");
    EXPECT_THAT(channels_of(frame), ElementsAre("B", "G", "R"));
    EXPECT_EQ(frame.at("G")[11], 0.5f);
    EXPECT_THAT(frame.notes, ElementsAre(HasSubstr("deep parts \"deep\"")));
    write(folder / "deep.exr", {deep});
    EXPECT_THAT(error_of([&] { read_exr(folder / "deep.exr"); }).line(), HasSubstr("flatten"));
}

TEST(ExrPartsTest, TruncatedAndFlippedPartsAreErrorsOrPictures) {
    const Folder folder;
    write_parts(folder / "a.exr", {{"rgba", "left", {"A", "B", "G", "R"}, whole}, {"albedo", "left", {"R"}, {{-1, 0}, {1, 1}}}}, whole);
    const std::string bytes = test::bytes_of(folder / "a.exr");
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
        test::put(folder / "cut.exr", bytes.substr(0, size));
        const Error e = error_of([&] { read_exr(folder / "cut.exr"); });
        EXPECT_EQ(e.kind(), ErrorKind::input) << size << ": " << e.line();
    }
    for (std::size_t at = 0; at < bytes.size(); at += 3)
        for (const int bit : {1, 64, 128}) {
            std::string flipped = bytes;
            flipped[at] = static_cast<char>(flipped[at] ^ bit);
            test::put(folder / "flip.exr", flipped);
            try {
                EXPECT_GT(read_exr(folder / "flip.exr").pixels(), 0u);
            } catch (const Error& e) {
                EXPECT_EQ(e.kind(), ErrorKind::input) << at << ": " << e.line();
            }
        }
}

} // namespace
} // namespace clvr
