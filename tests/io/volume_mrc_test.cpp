// MRC and CCP4 maps: modes, geometry, order of axes, stacks, old files.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/mrc_writers.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<double> two(const Folder& folder, MrcFields f, const std::string& bytes) {
    const Voxels v = read_volume(write(folder / "a.mrc", mrc_header(Sample({2, 1, 1}), f, {2, 1, 1}) + bytes));
    std::vector<double> values;
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        values.assign(v.data<T>(), v.data<T>() + v.count());
    });
    return values;
}

TEST(VolumeMrc, ReadsEveryModeInBothByteOrders) {
    const Folder folder;
    for (const bool big : {false, true}) {
        MrcFields f;
        f.big = big;
        f.mode = 0;
        EXPECT_THAT(two(folder, f, "\xfe\x01"), ElementsAre(-2, 1));
        f.imod_stamp = 1146047817;
        EXPECT_THAT(two(folder, f, "\xfe\x01"), ElementsAre(254, 1));
        f.imod_flags = 1;
        EXPECT_THAT(two(folder, f, "\xfe\x01"), ElementsAre(-2, 1));
        f.mode = 1;
        EXPECT_THAT(two(folder, f, bytes_of(std::vector<std::int16_t>{-300, 3}, big)), ElementsAre(-300, 3));
        f.mode = 2;
        EXPECT_THAT(two(folder, f, bytes_of(std::vector<float>{-0.5f, 3}, big)), ElementsAre(-0.5, 3));
        f.mode = 6;
        EXPECT_THAT(two(folder, f, bytes_of(std::vector<std::uint16_t>{65535, 3}, big)), ElementsAre(65535, 3));
        f.mode = 12;
        EXPECT_THAT(two(folder, f, bytes_of(std::vector<std::uint16_t>{0xc100, 0x3c00}, big)), ElementsAre(-2.5, 1));
    }
}

TEST(VolumeMrc, RefusesOtherModesByName) {
    const Folder folder;
    for (const auto& [mode, word] : {std::pair{3, "complex"}, {4, "complex"}, {16, "RGB"}, {101, "4 bits"}}) {
        MrcFields f;
        f.mode = mode;
        expect_error([&] { two(folder, f, std::string(100, '\1')); }, {word, std::to_string(mode)});
    }
    MrcFields f;
    f.mode = 55;
    expect_error([&] { two(folder, f, std::string(100, '\1')); }, {"mode 55"});
}

TEST(VolumeMrc, LengthsAreAngstroms) {
    const Folder folder;
    Sample s;
    s.geometry.spacing = {1.5e-7, 2e-7, 3e-7};
    s.geometry.origin = {-10e-7, 20e-7, 30e-7};
    const Geometry g = read_volume(write(folder / "a.ccp4", mrc(s))).geometry;
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(g.spacing[i] * 1e7, s.geometry.spacing[i] * 1e7, 1e-6);
        EXPECT_NEAR(g.origin[i] * 1e7, s.geometry.origin[i] * 1e7, 1e-5);
    }
    MrcFields f; // the crystallographic origin, in grid intervals, counts where ORIGIN is 0
    f.origin = false;
    f.start = {-4, 0, 7};
    const Double3 origin = read_volume(write(folder / "a.ccp4", mrc(s, f))).geometry.origin;
    EXPECT_NEAR(origin[0] * 1e7, -6, 1e-5);
    EXPECT_NEAR(origin[1] * 1e7, 0, 1e-5);
    EXPECT_NEAR(origin[2] * 1e7, 21, 1e-5);
}

TEST(VolumeMrc, SaysWhereTheCellIsMissing) {
    const Folder folder;
    MrcFields f;
    f.cell = false;
    const Voxels v = read_volume(write(folder / "a.mrc", mrc(Sample(), f)));
    EXPECT_EQ(v.geometry.spacing, (Double3{1, 1, 1}));
    EXPECT_EQ(v.geometry.origin, (Double3{0, 0, 0}));
    EXPECT_THAT(v.notes, Contains(HasSubstr("1 mm is assumed")));
    VolumeReadOptions options;
    options.spacing = Double3{2, 3, 4};
    EXPECT_EQ(read_volume(folder / "a.mrc", options).geometry.spacing, (Double3{2, 3, 4}));
}

TEST(VolumeMrc, TurnsColumnsRowsAndSectionsToXyz) {
    const Folder folder;
    const Sample s; // 5 x 4 x 3 along x, y, z
    for (const std::array<std::int32_t, 3> map : {std::array<std::int32_t, 3>{3, 2, 1}, {2, 3, 1}, {3, 1, 2}, {2, 1, 3}, {1, 3, 2}}) {
        MrcFields f;
        f.map = map;
        std::array<std::int32_t, 3> stored;
        for (std::size_t i = 0; i < 3; ++i) stored[i] = s.dims[static_cast<std::size_t>(map[i] - 1)];
        std::vector<std::int16_t> values;
        for (int c = 0; c < stored[2]; ++c)
            for (int b = 0; b < stored[1]; ++b)
                for (int a = 0; a < stored[0]; ++a) {
                    int xyz[3];
                    xyz[map[0] - 1] = a, xyz[map[1] - 1] = b, xyz[map[2] - 1] = c;
                    values.push_back(s.voxels[static_cast<std::size_t>((xyz[2] * s.dims[1] + xyz[1]) * s.dims[0] + xyz[0])]);
                }
        const Voxels v = read_volume(write(folder / "a.map", mrc_header(s, f, stored) + bytes_of(values)));
        ASSERT_EQ(v.dims, s.dims);
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(v.geometry.spacing[i], s.geometry.spacing[i], 1e-5);
            EXPECT_NEAR(v.geometry.origin[i], s.geometry.origin[i], 1e-4);
        }
        EXPECT_THAT(v.decisions, Contains(HasSubstr("turned to x, y, z")));
    }
}

TEST(VolumeMrc, ASkewedCellMakesAnObliqueGrid) {
    const Folder folder;
    MrcFields f;
    f.angles = {90, 90, 120};
    const Matrix3 d = read_volume(write(folder / "a.map", mrc(Sample(), f))).geometry.direction;
    EXPECT_NEAR(d.row[0][1], -0.5, 1e-6);
    EXPECT_NEAR(d.row[1][1], std::sqrt(0.75), 1e-6);
    EXPECT_NEAR(d.row[2][2], 1, 1e-6);
    f.angles = {10, 10, 170};
    EXPECT_THAT(read_volume(write(folder / "a.map", mrc(Sample(), f))).notes, Contains(HasSubstr("right angles")));
}

TEST(VolumeMrc, StacksOfVolumesHaveFramesAndStacksOfImagesSlices) {
    const Folder folder;
    const Sample all({5, 4, 6});
    MrcFields f;
    f.group = 401, f.mz = 3;
    write(folder / "a.mrc", mrc(all, f));
    VolumeReadOptions options;
    options.frame = 1;
    const Voxels v = read_volume(folder / "a.mrc", options);
    ASSERT_EQ(v.dims, (Int3{5, 4, 3}));
    EXPECT_TRUE(std::equal(all.voxels.begin() + 60, all.voxels.end(), v.data<std::int16_t>()));
    EXPECT_THAT(v.decisions, Contains(HasSubstr("frame 1 of 0 to 1")));
    EXPECT_EQ(v.frames, 2);
    f.mz = 4;
    expect_error([&] { read_volume(write(folder / "b.mrc", mrc(all, f))); }, {"6 sections", "4 in each"});
    f.group = 0, f.mz = 1;
    const Voxels images = read_volume(write(folder / "c.mrcs", mrc(all, f)));
    EXPECT_EQ(images.dims, all.dims);
    EXPECT_THAT(images.notes, Contains(HasSubstr("stack of images")));
    EXPECT_NEAR(images.geometry.spacing[2], 2, 1e-5);
}

TEST(VolumeMrc, ReadsOldFilesByTheirNamesAndMarkedOnesByTheirBytes) {
    const Folder folder;
    const Sample s;
    MrcFields f;
    f.marked = false;
    f.map = {0, 0, 0};
    EXPECT_EQ(read_volume(write(folder / "a.MRC", mrc(s, f))).dims, s.dims);
    EXPECT_EQ(read_volume(write(folder / "a.rec.GZ", deflated(mrc(s)))).dims, s.dims);
    EXPECT_EQ(read_volume(write(folder / "a.dat", mrc(s))).format, "MRC");
    expect_error([&] { read_volume(write(folder / "b.dat", mrc(s, f))); }, {"not a volume"});
    expect_error([&] { read_volume(write(folder / "b.map", std::string(2000, 'x'))); }, {"not an MRC file"});
    write(folder / "p.PAR", "general information");
    expect_error([&] { read_volume(write(folder / "p.rec", std::string(2000, 'x'))); }, {"Philips PAR/REC", "dcm2niix"});
}

TEST(VolumeMrc, RefusesExtendedHeadersThatAreNotThere) {
    const Folder folder;
    MrcFields f;
    f.extended_bytes = 1 << 30;
    const Sample s;
    expect_error([&] { read_volume(write(folder / "a.mrc", mrc_header(s, f, {5, 4, 3}) + bytes_of(s.voxels))); }, {"truncated"});
    f.extended_bytes = 2;
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), read_volume(write(folder / "b.mrc", mrc(s, f))).data<std::int16_t>()));
}

} // namespace
} // namespace clvr::test
