// Folders of slices: the order that names give, what is refused, PNG as slices.
#include "host/io/volume/slices.hpp"
#include "host/io/volume/volume_file.hpp"
#include "tests/io/tiff_writers.hpp"

#include <gmock/gmock.h>
#include <turbojpeg.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SliceStack stack_of(std::vector<std::string> names, bool allow_gaps = false) {
    std::sort(names.begin(), names.end());
    for (std::string& n : names) n = "the_folder/" + n;
    SliceStack stack = slice_stack("the_folder", names, allow_gaps);
    for (std::string& p : stack.paths) p.erase(0, std::string("the_folder/").size());
    return stack;
}
/// Names in the order in which slices must come.
void expect_order(const std::vector<std::string>& names) { EXPECT_THAT(stack_of(names).paths, ElementsAreArray(names)); }
void expect_refused(const std::vector<std::string>& names, const std::vector<std::string>& words) {
    expect_error([&] { stack_of(names); }, words);
}

TEST(SliceNames, AreOrderedByTheNumberThatVaries) {
    expect_order({"a8.tif", "a9.tif", "a10.tif"});
    expect_order({"slice.8", "slice.9", "slice.10", "slice.11"});
    expect_order({"z0.0.tif", "z0.5.tif", "z1.0.tif", "z1.5.tif"});
    expect_order({"z-1.5.tif", "z-1.0.tif", "z-0.5.tif", "z0.0.tif", "z0.5.tif"});
    expect_order({"z-2.tif", "z-1.tif", "z0.tif", "z1.tif"});
    expect_order({"pos_-3.tif", "pos_-2.tif", "pos_-1.tif"});
    expect_order({"-3.tif", "-2.tif", "-1.tif"});
    expect_order({"z-1.tif", "z+0.tif", "z+1.tif"});
    expect_order({"scan-8.tif", "scan-9.tif", "scan-10.tif"}); // a dash that all have is none of sign
    expect_order({"2024-01-8.tif", "2024-01-9.tif", "2024-01-10.tif"});
    expect_order({"img_z00_ch00.tif", "img_z01_ch00.tif", "img_z02_ch00.tif"});
    expect_order({"img_ch01_z8.tif", "img_ch01_z9.tif", "img_ch01_z10.tif"});
    expect_order({"0008.tif", "0009.tif", "0010.tif"});
    expect_order({"a8.tif", "a9.tiff", "a10.TIF"});
    expect_order({"IMG_8.tif", "img_9.tif", "Img_10.tif"});
    expect_order({"v1.9.tif", "v1.10.tif", "v1.11.tif"}); // behind a point, but counted
    expect_order({"1.2.840.8.tif", "1.2.840.9.tif", "1.2.840.10.tif"});
    expect_order({"z0.25.tif", "z0.5.tif", "z0.75.tif", "z1.tif"});
    expect_order({"10.tif", "20.tif", "30.tif"});
    expect_order({"z0.0.tif", "z0.3.tif", "z0.7.tif", "z1.0.tif", "z1.3.tif"});       // rounded thirds
    expect_order({"20240101235958.tif", "20240101235959.tif", "20240102000004.tif"}); // times, not counts
    expect_order({"99999999999999999999998.tif", "99999999999999999999999.tif", "100000000000000000000000.tif"});
    expect_order({"only.tif"});
    expect_order({"z8/image.tif", "z9/image.tif", "z10/image.tif"});
}

TEST(SliceNames, WhatIsNotSureIsRefused) {
    std::vector<std::string> grid;
    for (int t = 0; t < 2; ++t)
        for (int z = 0; z < 3; ++z) grid.push_back(fmt::format("img_t{}_z{}.tif", t, z));
    expect_refused(grid, {"the_folder", "several numbers vary", "\"img_t\" 0 to 1", "\"_z\" 0 to 2"});
    expect_refused({"a1.tif", "a2.tif", "a3.tif", "overview.tif"}, {"overview.tif", "3 other slices", "move it"});
    expect_refused({"a1.tif", "a2.tif", "b1.tif", "b2.tif"}, {"2 files", "a1.tif", "b1.tif"});
    expect_refused({"x.tif", "y.tif"}, {"x.tif", "y.tif"});
    expect_refused({"a1.tif", "a01.tif", "a2.tif"}, {"a1.tif", "a01.tif", "same number"});
    expect_refused({"a1.tif", "a1.tiff"}, {"same number"});
    expect_refused({"a/1.tif", "a/2.tif", "b/1.tif", "b/2.tif"}, {"a/1.tif", "b/1.tif"});
    expect_refused({"s1/1.tif", "s1/2.tif", "s2/1.tif", "s2/2.tif"}, {"several numbers"});
    expect_refused({"slice.tif", "slice1.tif", "slice2.tif"}, {"slice.tif"});
    expect_refused({"z0,0.tif", "z0,5.tif", "z1,0.tif", "z1,5.tif"}, {"several numbers"});
}

TEST(SliceNames, MissingSlicesAreAnErrorOrNoted) {
    expect_refused({"a1.tif", "a2.tif", "a4.tif", "a5.tif"}, {"slice 3 is missing", "a2.tif", "a4.tif", "--allow-gaps"});
    expect_refused({"z0.0.tif", "z0.5.tif", "z1.5.tif", "z2.0.tif"}, {"slice 1.0 is missing"});
    expect_refused({"z0.00.tif", "z0.50.tif", "z1.00.tif", "z1.70.tif"}, {"step of 0.7", "elsewhere of 0.5"});
    const SliceStack s = stack_of({"a1.tif", "a2.tif", "a4.tif", "a5.tif"}, true);
    EXPECT_THAT(s.paths, ElementsAre("a1.tif", "a2.tif", "a4.tif", "a5.tif"));
    EXPECT_THAT(s.notes, ElementsAre(HasSubstr("slice 3 is missing")));
}

TEST(SliceNames, NumbersThatVaryTogetherAreOne) {
    const SliceStack s = stack_of({"s1_z0.5.tif", "s2_z1.0.tif", "s3_z1.5.tif"});
    EXPECT_THAT(s.paths, ElementsAre("s1_z0.5.tif", "s2_z1.0.tif", "s3_z1.5.tif"));
    EXPECT_THAT(s.notes, IsEmpty());
    EXPECT_THAT(stack_of({"s1_z3.tif", "s2_z2.tif", "s3_z1.tif"}).notes, ElementsAre(HasSubstr("vary together")));
}

TEST(SliceFolder, TiffSlicesAreReadInOrderAndMustBeAlike) {
    const Folder folder;
    const Sample s({5, 4, 12});
    const auto pages = tiff_pages(s);
    for (std::size_t k = 0; k < pages.size(); ++k) write(folder / fmt::format("s/ct_{}_a.tif", k + 1), tiff({pages[k]}));
    write(folder / "s/notes.txt", "text");
    Voxels v = read_volume(folder / "s");
    EXPECT_EQ(v.dims, s.dims);
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    EXPECT_THAT(v.decisions, Contains(HasSubstr("\"ct_\" 1 to 12")));
    write(folder / "s/overview.tif", tiff({tiff_pages(Sample({9, 9, 1}))[0]}));
    expect_error([&] { read_volume(folder / "s"); }, {"overview.tif"});
    std::filesystem::remove(folder / "s/overview.tif");
    write(folder / "s/preview.png", png_file(1, 1, 8, PNG_COLOR_TYPE_GRAY, "x"));
    EXPECT_THAT(read_volume(folder / "s").notes, Contains(HasSubstr("1 PNG file is left out")));
    std::filesystem::remove(folder / "s/ct_5_a.tif");
    expect_error([&] { read_volume(folder / "s"); }, {"slice 5 is missing"});
    VolumeReadOptions gaps;
    gaps.allow_gaps = true;
    EXPECT_EQ(read_volume(folder / "s", gaps).dims[2], 11);
    write(folder / "s/ct_5_a.tif", tiff({pages[0], pages[1]}));
    expect_error([&] { read_volume(folder / "s"); }, {"2 pages", "ct_5_a.tif"});
    write(folder / "s/ct_5_a.tif", tiff({tiff_pages(Sample({4, 4, 1}))[0]}));
    expect_error([&] { read_volume(folder / "s"); }, {"4 x 4", "5 x 4", "ct_5_a.tif", "ct_1_a.tif"});
    write(folder / "s/ct_5_a.tif", tiff({TiffPage{5, 4, 8, 1, 1, 1, 1, std::string(20, 'x')}}));
    expect_error([&] { read_volume(folder / "s"); }, {"5 x 4 u8", "5 x 4 i16"});
}

TEST(SliceFolder, TakesSpacingAndCalibrationFromTheSlices) {
    const Folder folder;
    const auto slices = [&](const std::string& first, const std::string& others) {
        for (int k = 1; k <= 3; ++k) write(folder / fmt::format("s/a{}.tif", k), described_tiff(1, k == 1 ? first : others, {2, 1}));
        return read_volume(folder / "s");
    };
    const std::string head = "ImageJ=1.53t\nunit=um\n";
    Voxels v = slices(head + "spacing=3\n", head);
    EXPECT_NEAR(v.geometry.spacing[0], 5e-4, 1e-9);
    EXPECT_NEAR(v.geometry.spacing[2], 3e-3, 1e-9);
    v = slices(head, head); // ImageJ writes no distance for single slices
    EXPECT_NEAR(v.geometry.spacing[2], 5e-4, 1e-9);
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("no spacing z")));
    const std::string calibrated = head + "cf=0\nc0=-32768\nc1=1\n";
    EXPECT_EQ(slices(calibrated, calibrated).intercept, -32768);
    expect_error([&] { slices(calibrated, head); }, {"calibration", "a2.tif", "a1.tif"});
    const std::string ome = ome_xml(R"(SizeX="6" SizeY="7" SizeZ="1" PhysicalSizeX="0.2" PhysicalSizeY="0.2" PhysicalSizeZ="0.7")");
    EXPECT_NEAR(slices(ome, ome).geometry.spacing[2], 7e-4, 1e-9);
}

TEST(SliceFolder, APictureOnTopDoesNotHideTheVolumeBelow) {
    const Folder folder;
    for (int k = 1; k <= 3; ++k) write(folder / fmt::format("s/series/a{}.tif", k), described_tiff(1, ""));
    write(folder / "s/logo.png", png_file(1, 1, 8, PNG_COLOR_TYPE_GRAY, "x"));
    const Voxels v = read_volume(folder / "s");
    EXPECT_EQ(v.dims, (Int3{6, 7, 3}));
    EXPECT_THAT(v.notes, Contains(HasSubstr("1 PNG file is left out")));
}

class PngSlices : public ::testing::Test {
protected:
    /// The picture twice, as a folder of two slices.
    Voxels twice(const std::string& png, const VolumeReadOptions& o = {}) const {
        write(folder_ / "s/a9.png", png);
        write(folder_ / "s/a10.PNG", png);
        return read_volume(folder_ / "s", o);
    }
    Voxels once(const std::string& png) const { return read_volume(write(folder_ / "a.png", png)); }
    Folder folder_;
};

TEST_F(PngSlices, GreyOfEightAndSixteenBits) {
    const std::string eight = "abcdef";
    Voxels v = twice(png_file(3, 2, 8, PNG_COLOR_TYPE_GRAY, eight));
    EXPECT_EQ(v.dims, (Int3{3, 2, 2}));
    EXPECT_EQ(v.type, VoxelType::u8);
    EXPECT_EQ(std::string(v.bytes.begin(), v.bytes.end()), eight + eight);
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("1 mm is assumed"))); // pHYs is of print
    VolumeReadOptions o;
    o.spacing = Double3{1, 2, 3};
    EXPECT_EQ(twice(png_file(3, 2, 8, PNG_COLOR_TYPE_GRAY, eight), o).geometry.spacing, *o.spacing);

    std::vector<std::uint16_t> values(64 * 48);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i * 21);
    for (const bool interlaced : {false, true}) {
        v = once(png_file(64, 48, 16, PNG_COLOR_TYPE_GRAY, bytes_of(values, true), {}, interlaced));
        EXPECT_EQ(v.dims, (Int3{64, 48, 1}));
        ASSERT_EQ(v.type, VoxelType::u16);
        EXPECT_TRUE(std::equal(values.begin(), values.end(), v.data<std::uint16_t>()));
    }
    // By number: 9 before 10.
    write(folder_ / "t/a9.png", png_file(1, 1, 8, PNG_COLOR_TYPE_GRAY, "x"));
    write(folder_ / "t/a10.png", png_file(1, 1, 8, PNG_COLOR_TYPE_GRAY, "y"));
    v = read_volume(folder_ / "t");
    EXPECT_EQ(std::string(v.bytes.begin(), v.bytes.end()), "xy");
}

TEST_F(PngSlices, FewBitsAreTakenAsStored) {
    EXPECT_THAT(once(png_file(4, 1, 1, PNG_COLOR_TYPE_GRAY, "\xa0")).bytes, ElementsAre(1, 0, 1, 0));
    EXPECT_THAT(once(png_file(4, 1, 2, PNG_COLOR_TYPE_GRAY, "\x1b")).bytes, ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(once(png_file(2, 1, 4, PNG_COLOR_TYPE_GRAY, "\x5c")).bytes, ElementsAre(5, 12));
}

TEST_F(PngSlices, ColourIsReadWhereItIsGreyElseRefused) {
    Voxels v = once(png_file(2, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA,
                             "a\xff"
                             "b\x80"));
    EXPECT_EQ(std::string(v.bytes.begin(), v.bytes.end()), "ab");
    EXPECT_THAT(v.notes, Contains(HasSubstr("alpha is left out")));
    v = once(png_file(2, 1, 8, PNG_COLOR_TYPE_RGB, "aaabbb"));
    EXPECT_EQ(std::string(v.bytes.begin(), v.bytes.end()), "ab");
    EXPECT_THAT(v.decisions, Contains(HasSubstr("equal")));
    v = once(png_file(2, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA,
                      "aAaAaA\xff\xff"
                      "bBbBbB\xff\xff"));
    EXPECT_EQ(v.data<std::uint16_t>()[0], 0x6141);
    expect_error([&] { once(png_file(2, 1, 8, PNG_COLOR_TYPE_RGB, "aaabbc")); }, {"pixel 1, 0", "coloured"});
    v = once(png_file(2, 1, 8, PNG_COLOR_TYPE_PALETTE, std::string("\1\0", 2), "xxxyyy"));
    EXPECT_EQ(std::string(v.bytes.begin(), v.bytes.end()), "yx");
    expect_error([&] { once(png_file(2, 1, 8, PNG_COLOR_TYPE_PALETTE, std::string("\1\0", 2), "xxxyyz")); }, {"colours in a table"});
}

TEST_F(PngSlices, AreRefusedWhereNotAlikeOrDamaged) {
    twice(png_file(1, 1, 8, PNG_COLOR_TYPE_GRAY, "x"));
    write(folder_ / "s/a10.PNG", png_file(1, 1, 16, PNG_COLOR_TYPE_GRAY, "xx"));
    expect_error([&] { read_volume(folder_ / "s"); }, {"a10.PNG", "16 bits", "a9.png", "8 bits"});
    VolumeReadOptions o;
    o.channel = 1;
    expect_error([&] { twice(png_file(1, 1, 8, PNG_COLOR_TYPE_GRAY, "x"), o); }, {"channel 1"});
    const std::string whole = png_file(40, 30, 8, PNG_COLOR_TYPE_GRAY, std::string(1200, 'x'));
    for (std::size_t i = 0; i < whole.size() - 1; i += 3) {
        expect_error([&] { once(whole.substr(0, i)); }, {"a.png"});
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 16);
        try {
            EXPECT_EQ(once(damaged).count(), 1200u);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input) << e.line();
        }
    }
    std::string huge = whole; // 2^31 - 1 pixels across, with a sound checksum
    huge.replace(16, 8, "\x7f\xff\xff\xff\x7f\xff\xff\xff");
    huge.replace(29, 4, number(static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(&huge[12]), 17)), true));
    expect_error([&] { once(huge); }, {"a.png"});
}

/// A JPEG of one value, grey or with colour channels.
std::string jpeg_of(int width, int height, const std::vector<unsigned char>& pixels, bool colour) {
    const std::unique_ptr<void, int (*)(tjhandle)> handle(tjInitCompress(), &tjDestroy);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    EXPECT_EQ(tjCompress2(handle.get(), pixels.data(), width, 0, height, colour ? TJPF_RGB : TJPF_GRAY, &bytes, &size,
                          colour ? TJSAMP_444 : TJSAMP_GRAY, 100, 0),
              0);
    const std::string jpeg(reinterpret_cast<const char*>(bytes), size);
    tjFree(bytes);
    return jpeg;
}

TEST(JpegSlices, GreyIsReadColourRefused) {
    const Folder folder;
    const std::vector<unsigned char> grey(16 * 8, 100);
    write(folder / "s/a9.jpg", jpeg_of(16, 8, grey, false));
    write(folder / "s/a10.JPEG", jpeg_of(16, 8, std::vector<unsigned char>(16 * 8, 200), false));
    Voxels v = read_volume(folder / "s");
    EXPECT_EQ(v.dims, (Int3{16, 8, 2}));
    EXPECT_EQ(v.bytes[5], 100);
    EXPECT_EQ(v.bytes[128], 200);
    EXPECT_THAT(v.decisions, Contains(HasSubstr("lossy")));
    v = read_volume(write(folder / "b.jpg", jpeg_of(16, 8, std::vector<unsigned char>(3 * 16 * 8, 100), true)));
    EXPECT_EQ(v.dims, (Int3{16, 8, 1}));
    EXPECT_EQ(v.bytes[5], 100);
    std::vector<unsigned char> red(3 * 16 * 8, 0);
    for (std::size_t i = 0; i < red.size(); i += 3) red[i] = 200;
    expect_error([&] { read_volume(write(folder / "b.jpg", jpeg_of(16, 8, red, true))); }, {"coloured"});
    const std::string whole = jpeg_of(16, 8, grey, false);
    for (std::size_t i = 4; i < whole.size() - 4; i += 5)
        expect_error([&] { read_volume(write(folder / "b.jpg", whole.substr(0, i))); }, {"b.jpg"});
    write(folder / "t/a.bmp", "BM");
    expect_error([&] { read_volume(folder / "t"); }, {"1 BMP file", "PNG or TIFF"});
}

} // namespace
} // namespace clvr::test
