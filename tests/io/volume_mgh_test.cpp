// FreeSurfer's MGH and MGZ.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/mgh_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<double> two(const Folder& folder, std::int32_t type, const std::string& bytes) {
    const Voxels v = read_volume(write(folder / "a.mgh", mgh_header(Sample({2, 1, 1}), type) + bytes));
    std::vector<double> values;
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        values.assign(v.data<T>(), v.data<T>() + v.count());
    });
    return values;
}

TEST(VolumeMgh, ReadsEveryType) {
    const Folder folder;
    EXPECT_THAT(two(folder, 0, "\xfe\x01"), ElementsAre(254, 1));
    EXPECT_THAT(two(folder, 1, bytes_of(std::vector<std::int32_t>{-70000, 3}, true)), ElementsAre(-70000, 3));
    EXPECT_THAT(two(folder, 3, bytes_of(std::vector<float>{-0.5f, 3}, true)), ElementsAre(-0.5, 3));
    EXPECT_THAT(two(folder, 4, bytes_of(std::vector<std::int16_t>{-300, 3}, true)), ElementsAre(-300, 3));
    EXPECT_THAT(two(folder, 10, bytes_of(std::vector<std::uint16_t>{65535, 3}, true)), ElementsAre(65535, 3));
    expect_error([&] { two(folder, 6, std::string(100, '\1')); }, {"MGH type 6"});
}

TEST(VolumeMgh, WithoutGeometryItIsFreeSurfersOwn) {
    const Folder folder;
    const Sample s;
    const Voxels v = read_volume(write(folder / "a.mgh", mgh_header(s, 4, 1, false) + bytes_of(s.voxels, true)));
    EXPECT_EQ(v.geometry.spacing, (Double3{1, 1, 1}));
    // RAS (-i, k, -j) around the centre is LPS (i, -k, -j)
    EXPECT_EQ(v.geometry.direction.row, (Matrix3{{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}}}.row));
    EXPECT_EQ(v.geometry.origin, (Double3{-2.5, 1.5, 2}));
    EXPECT_THAT(v.notes, Contains(HasSubstr("goodRASFlag")));
}

TEST(VolumeMgh, ReadsTheChosenFrameAndPassesOverTags) {
    const Folder folder;
    const Sample s;
    std::vector<std::int16_t> all;
    for (std::int16_t t = 0; t < 3; ++t)
        for (const auto v : s.voxels) all.push_back(static_cast<std::int16_t>(v + t));
    write(folder / "a.MGH.gz", deflated(mgh_header(s, 4, 3) + bytes_of(all, true) + std::string(120, 't')));
    VolumeReadOptions options;
    options.frame = 2;
    const Voxels v = read_volume(folder / "a.MGH.gz", options);
    for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], s.voxels[i] + 2);
    EXPECT_TRUE(v.notes.empty());
    EXPECT_THAT(v.decisions, Contains(HasSubstr("frame 2 of 0 to 2")));
    EXPECT_EQ(v.frames, 3);
}

TEST(VolumeMgh, IsKnownByItsBytesAndRefusedWhereTheyAreOthers) {
    const Folder folder;
    const Sample s;
    EXPECT_EQ(read_volume(write(folder / "a", mgh(s))).format, "MGH");
    std::string other = mgh(s);
    other[3] = 2;
    expect_error([&] { read_volume(write(folder / "b.mgh", other)); }, {"version is 2"});
    other = mgh(s);
    other.replace(30, 4, std::string(4, '\0'));
    expect_error([&] { read_volume(write(folder / "c.mgh", other)); }, {"spacing"});
}

} // namespace
} // namespace clvr::test
