// TIFF stacks: files of pages, folders of slices, ImageJ's calibration.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/volume_writers.hpp"

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

} // namespace
} // namespace clvr::test
