// TIFF stacks: files of pages, folders of slices, ImageJ's calibration.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/tiff_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(VolumeTiff, KeepsEightBitsAndFloats) {
    const Folder folder;
    TiffPage bytes{3, 2, 8, 1};
    bytes.pixels = "abcdef";
    const Voxels v = read_volume(write(folder / "a.tif", tiff({bytes, bytes})));
    EXPECT_EQ(v.type, VoxelType::u8);
    EXPECT_EQ(v.dims, (Int3{3, 2, 2}));
    EXPECT_EQ(std::string(v.bytes.begin(), v.bytes.end()), "abcdefabcdef");

    TiffPage floats{3, 2, 32, 3};
    floats.pixels = bytes_of(std::vector<float>{1, 2, 3, 4, 5.5f, -6});
    const Voxels w = read_volume(write(folder / "b.tif", tiff({floats})));
    EXPECT_EQ(w.type, VoxelType::f32);
    EXPECT_EQ(w.data<float>()[4], 5.5f);
    EXPECT_EQ(w.dims[2], 1);

    TiffPage wide{3, 2, 32, 1};
    wide.pixels = bytes_of(std::vector<std::uint32_t>{1, 2, 3, 4, 5, 70000});
    EXPECT_EQ(read_volume(write(folder / "c.tif", tiff({wide}))).data<float>()[5], 70000);
}

TEST(VolumeTiff, TakesImageJsCalibrationAndFrames) {
    const Folder folder;
    const Sample s({5, 4, 6});
    auto pages = tiff_pages(s);
    pages[0].description = "ImageJ=1.53\nimages=6\nslices=3\nframes=2\nunit=micron\nspacing=3.5\n";
    VolumeReadOptions options;
    options.frame = 1;
    const Voxels v = read_volume(write(folder / "a.tif", tiff(pages)), options);
    EXPECT_EQ(v.frames, 2);
    EXPECT_EQ(v.dims, (Int3{5, 4, 3}));
    EXPECT_TRUE(std::equal(s.voxels.begin() + 60, s.voxels.end(), v.data<std::int16_t>()));
    EXPECT_NEAR(v.geometry.spacing[0], 0.5e-3, 1e-9); // 2 pixels a micrometre
    EXPECT_NEAR(v.geometry.spacing[2], 3.5e-3, 1e-9);
    EXPECT_TRUE(v.notes.empty());
    options.spacing = Double3{1, 2, 3};
    EXPECT_EQ(read_volume(folder / "a.tif", options).geometry.spacing, *options.spacing);
}

TEST(VolumeTiff, RefusesWhatIsNoStackOfGreyValues) {
    const Folder folder;
    const auto refused = [&](const std::vector<TiffPage>& pages, const std::vector<std::string>& words) {
        expect_error([&] { read_volume(write(folder / "a.tif", tiff(pages))); }, words);
    };
    const TiffPage grey = tiff_pages(Sample())[0];
    TiffPage page = grey;
    page.samples = 3, page.photometric = 2;
    refused({page}, {"3 channels"});
    page = grey, page.photometric = 5;
    refused({page}, {"photometric 5"});
    page = grey, page.bits = 40, page.format = 1, page.pixels.resize(100);
    refused({page}, {"40 bits"});
    page = grey, page.format = 5;
    refused({page}, {"sample format 5"});
    page = tiff_pages(Sample({4, 5, 1}))[0];
    refused({grey, page}, {"page 1 is 4 x 5", "5 x 4"});
    page = grey, page.width = 60000, page.height = 60000;
    refused({page}, {});
    page = grey, page.pixels.resize(30); // the count of bytes is too small for the page
    refused({page}, {"StripByteCounts"});
}

/// A page of one row with the tags of `change` on top.
std::string row_tiff(const std::string& row, std::uint32_t width, std::uint16_t bits, std::uint16_t format,
                     const std::function<void(const TiffWriter&, std::map<std::uint16_t, TiffTag>&)>& change = {}, bool big = false) {
    TiffWriter w(big);
    auto tags = w.grey(width, 1, bits, format);
    if (change) change(w, tags);
    w.page(tags, {row});
    return w.file();
}

TEST(VolumeTiff, ReadsAnyNumberOfBits) {
    const Folder folder;
    const auto values = [&](const std::string& file) {
        const Voxels v = read_volume(write(folder / "a.tif", file));
        std::vector<double> numbers(v.count());
        with_voxel_type(v.type, [&](auto zero) {
            for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(v.data<decltype(zero)>()[i]);
        });
        return numbers;
    };
    using Values = std::vector<double>;
    constexpr std::uint16_t whole = 1, with_sign = 2, real = 3;
    EXPECT_EQ(values(row_tiff("\xa0", 4, 1, whole)), (Values{1, 0, 1, 0}));
    EXPECT_EQ(values(row_tiff("\x1b", 4, 2, whole)), (Values{0, 1, 2, 3}));
    EXPECT_EQ(values(row_tiff("\x5f", 2, 4, with_sign)), (Values{5, -1}));
    EXPECT_EQ(values(row_tiff("\x12\x3f\xff", 2, 12, whole)), (Values{0x123, 0xfff}));
    EXPECT_EQ(values(row_tiff("\x12\x3f\xff", 2, 12, with_sign)), (Values{0x123, -1}));
    EXPECT_EQ(values(row_tiff(std::string("\xff\xc0\x00\x01\x80", 5), 4, 10, whole)), (Values{1023, 0, 0, 384}));
    EXPECT_EQ(values(row_tiff("\1\2\3", 1, 24, whole)), (Values{0x030201}));
    EXPECT_EQ(values(row_tiff("\1\2\3", 1, 24, whole, {}, true)), (Values{0x010203}));
    // Half floats 1, -2, 2^-24 (the least), 65504.
    EXPECT_EQ(values(row_tiff(bytes_of(std::vector<std::uint16_t>{0x3c00, 0xc000, 1, 0x7bff}), 4, 16, real)),
              (Values{1, -2, 0x1p-24, 65504}));
    // 24 bits: sign, 7 of exponent, 16 of mantissa: 1, -1.5.
    EXPECT_EQ(values(row_tiff(std::string("\0\0\x3f\0\x80\xbf", 6), 2, 24, real)), (Values{1, -1.5}));
    // The lowest bit first.
    const auto low_first = [](const TiffWriter& w, auto& tags) { tags[266] = w.words({2}); };
    EXPECT_EQ(values(row_tiff("\x05", 4, 1, whole, low_first)), (Values{1, 0, 1, 0}));
}

TEST(VolumeTiff, ReadsChannelsWithinPixels) {
    const Folder folder;
    const auto with = [](std::uint16_t samples, std::uint16_t photometric, std::uint16_t planar = 1) {
        return [=](const TiffWriter& w, std::map<std::uint16_t, TiffTag>& tags) {
            tags[277] = w.words({samples}), tags[262] = w.words({photometric}), tags[284] = w.words({planar});
            tags[258] = w.words(std::vector<std::uint16_t>(samples, 8)), tags[339] = w.words(std::vector<std::uint16_t>(samples, 1));
        };
    };
    const auto text = [](const Voxels& v) { return std::string(v.bytes.begin(), v.bytes.end()); };
    VolumeReadOptions one;
    one.channel = 1;
    const std::string colour = write(folder / "a.tif", row_tiff("rgbRGB", 2, 8, 1, with(3, 2)));
    expect_error([&] { read_volume(colour); }, {"3 channels", "--channel"});
    const Voxels green = read_volume(colour, one);
    EXPECT_EQ(text(green), "gG");
    EXPECT_THAT(green.decisions, Contains(HasSubstr("red, green, blue")));
    const std::string two = write(folder / "b.tif", row_tiff("abAB", 2, 8, 1, with(2, 1)));
    EXPECT_EQ(text(read_volume(two)), "aA");
    EXPECT_THAT(read_volume(two).notes, Contains(HasSubstr("2 channels")));
    EXPECT_EQ(text(read_volume(two, one)), "bB");
    const std::string alpha = write(folder / "c.tif", row_tiff("abAB", 2, 8, 1, [&](const TiffWriter& w, auto& tags) {
                                        with(2, 1)(w, tags);
                                        tags[338] = w.words({2});
                                    }));
    EXPECT_THAT(read_volume(alpha).notes, Contains(HasSubstr("alpha is left out")));
    TiffWriter w;
    auto tags = w.grey(2, 1, 8);
    with(2, 1, 2)(w, tags);
    w.page(tags, {"aA", "bB"});
    EXPECT_EQ(text(read_volume(write(folder / "d.tif", w.file()), one)), "bB");
    one.channel = 2;
    expect_error([&] { read_volume(two, one); }, {"channel 2", "2 channels"});
}

TEST(VolumeTiff, TakesTheSlicesOfImageDepth) {
    const Folder folder;
    const Sample s({20, 18, 5});
    for (const bool packed : {false, true})
        for (const bool big : {false, true}) {
            const Voxels v = read_volume(write(folder / "a.tif", deep_tiff(s.dims, s.voxels, packed, big)));
            ASSERT_EQ(v.dims, s.dims);
            EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
        }
    for (const std::uint32_t strip_rows : {18u, 7u}) { // strips for each slice
        TiffWriter w;
        std::vector<std::string> strips;
        for (std::size_t z = 0; z < 5; ++z)
            for (std::uint32_t y = 0; y < 18; y += strip_rows) {
                const auto at = s.voxels.begin() + static_cast<std::ptrdiff_t>(20 * (18 * z + y));
                strips.push_back(bytes_of(std::vector<std::int16_t>(at, at + 20 * std::min(strip_rows, 18 - y))));
            }
        auto tags = w.grey(20, 18, 16, 2);
        tags[278] = w.longs({strip_rows}), tags[32997] = w.longs({5});
        w.page(tags, strips);
        const Voxels v = read_volume(write(folder / "b.tif", w.file()));
        ASSERT_EQ(v.dims, s.dims);
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    }
    TiffWriter w;
    auto tags = w.grey(20, 18, 16, 2);
    tags[32997] = w.longs({5}), tags[259] = w.words({5});
    w.page(tags, {std::string(100, 'x')});
    expect_error([&] { read_volume(write(folder / "c.tif", w.file())); }, {"5 slices", "ImageDepth"});
    tags[259] = w.words({1}), tags[32997] = w.longs({0x7fffffff});
    TiffWriter huge;
    huge.page(tags, {std::string(720, 'x')});
    expect_error([&] { read_volume(write(folder / "c.tif", huge.file())); }, {"c.tif"});
}

TEST(VolumeTiff, NamesCodecsAndPredictorsThatItLacks) {
    const Folder folder;
    for (const auto& [compression, name] : std::map<std::uint16_t, const char*>{{33003, "JPEG 2000"},
                                                                                {33005, "JPEG 2000"},
                                                                                {34712, "JPEG 2000"},
                                                                                {50002, "JPEG XL"},
                                                                                {34933, "PNG"},
                                                                                {22610, "JPEG XR"},
                                                                                {34676, "SGI LogLuv"},
                                                                                {4711, "4711"}}) {
        const auto packed = [c = compression](const TiffWriter& w, auto& tags) { tags[259] = w.words({c}); };
        expect_error([&] { read_volume(write(folder / "a.tif", row_tiff("abcd", 4, 8, 1, packed))); },
                     {fmt::format("compression {}", name), "not supported", "deflate"});
    }
    const auto predicted = [](const TiffWriter& w, auto& tags) { tags[259] = w.words({5}), tags[317] = w.words({2}); };
    expect_error([&] { read_volume(write(folder / "a.tif", row_tiff("abc", 2, 12, 1, predicted))); }, {"predictor 2", "12 bits"});
}

TEST(VolumeTiff, SaysHowPixelsAreShown) {
    const Folder folder;
    const auto notes = [&](const auto& change) { return read_volume(write(folder / "a.tif", row_tiff("abcd", 4, 8, 1, change))).notes; };
    EXPECT_THAT(notes([](const TiffWriter& w, auto& tags) { tags[274] = w.words({4}); }), Contains(HasSubstr("bottom left")));
    EXPECT_THAT(notes([](const TiffWriter& w, auto& tags) { tags[262] = w.words({0}); }), Contains(HasSubstr("as white")));
    const auto palette = [](bool grey, bool imagej) {
        return [=](const TiffWriter& w, std::map<std::uint16_t, TiffTag>& tags) {
            std::vector<std::uint16_t> colours(3 * 256);
            for (std::size_t i = 0; i < colours.size(); ++i) colours[i] = static_cast<std::uint16_t>(grey || i < 256 ? i % 256 * 257 : 7);
            tags[262] = w.words({3}), tags[320] = w.words(colours);
            if (imagej) tags[270] = w.text("ImageJ=1.53t\n");
        };
    };
    EXPECT_THAT(notes(palette(true, false)), ::testing::ElementsAre(HasSubstr("1 mm")));
    EXPECT_THAT(notes(palette(false, true)), Contains(HasSubstr("colour table")));
    expect_error([&] { notes(palette(false, false)); }, {"colours in a table"});
}

TEST(VolumeTiff, LeavesOutSmallerCopies) {
    const Folder folder;
    TiffWriter w;
    for (const std::uint32_t edge : {64u, 32u, 16u}) w.page(w.grey(edge, edge, 8), {std::string(edge * edge, static_cast<char>(edge))});
    const Voxels v = read_volume(write(folder / "a.tif", w.file()));
    EXPECT_EQ(v.dims, (Int3{64, 64, 1}));
    EXPECT_THAT(v.notes, Contains(HasSubstr("2 pages are smaller copies")));
    w.page(w.grey(48, 64, 8), {std::string(48 * 64, 'x')});
    expect_error([&] { read_volume(write(folder / "a.tif", w.file())); }, {"page 3 is 48 x 64", "64 x 64"});
}

} // namespace
} // namespace clvr::test
