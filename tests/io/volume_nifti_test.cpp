// NIfTI: types, scale, orientation, frames, and what is refused.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/volume_writers.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

template <class T>
std::vector<T> samples_of(const Sample& s) {
    std::vector<T> values;
    for (const auto v : s.voxels) values.push_back(static_cast<T>(v));
    return values;
}

template <class T>
Voxels read_type(const Folder& folder, int datatype, bool big) {
    const Sample s;
    NiftiFields f;
    f.datatype = datatype, f.sample_bytes = sizeof(T), f.big = big;
    return read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(samples_of<T>(s), big))));
}

TEST(VolumeNifti, KeepsSmallTypesAndWidensTheRest) {
    const Folder folder;
    for (const bool big : {false, true}) {
        EXPECT_EQ(read_type<std::uint8_t>(folder, 2, big).type, VoxelType::u8);
        EXPECT_EQ(read_type<std::int8_t>(folder, 256, big).type, VoxelType::i8);
        EXPECT_EQ(read_type<std::int16_t>(folder, 4, big).type, VoxelType::i16);
        EXPECT_EQ(read_type<std::uint16_t>(folder, 512, big).type, VoxelType::u16);
        const Sample s;
        for (const Voxels& v : {read_type<float>(folder, 16, big), read_type<double>(folder, 64, big),
                                read_type<std::int32_t>(folder, 8, big), read_type<std::int64_t>(folder, 1024, big)}) {
            ASSERT_EQ(v.type, VoxelType::f32);
            for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<float>()[i], static_cast<float>(s.voxels[i]));
        }
        EXPECT_THAT(read_type<double>(folder, 64, big).notes, Contains(HasSubstr("f64 voxels are kept as f32")));
        EXPECT_EQ(read_type<std::uint32_t>(folder, 768, big).type, VoxelType::f32);
        EXPECT_EQ(read_type<std::uint64_t>(folder, 1280, big).type, VoxelType::f32);
    }
}

TEST(VolumeNifti, KeepsSlopeAndInterceptBesideTheStoredType) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.slope = 2.5, f.intercept = -1024;
    const Voxels v = read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels))));
    EXPECT_EQ(v.type, VoxelType::i16);
    EXPECT_EQ(v.slope, 2.5);
    EXPECT_EQ(v.intercept, -1024);
    f.slope = std::nan("");
    EXPECT_EQ(read_volume(write(folder / "b.nii", nifti(s, f, bytes_of(s.voxels)))).slope, 1);
    f.slope = 0;
    EXPECT_EQ(read_volume(write(folder / "c.nii", nifti(s, f, bytes_of(s.voxels)))).intercept, 0);
    f.slope = std::numeric_limits<double>::infinity();
    expect_error([&] { read_volume(write(folder / "d.nii", nifti(s, f, bytes_of(s.voxels)))); }, {"slope inf"});
    f.slope = 1, f.intercept = std::nan("");
    expect_error([&] { read_volume(write(folder / "e.nii", nifti(s, f, bytes_of(s.voxels)))); }, {"intercept nan"});
}

TEST(VolumeNifti, TakesTheQuaternionWhereThereIsNoMatrix) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.sform = 0, f.qform = 1;
    f.quatern = {0, 0, std::sin(M_PI / 4)}; // 90 degrees about z in RAS: i -> +y, j -> -x
    for (const double handed : {1.0, -1.0}) {
        f.qfac = handed;
        const Geometry g = read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels)))).geometry;
        const Matrix3 expected{{{{0, 1, 0}, {-1, 0, 0}, {0, 0, handed}}}}; // in LPS: i -> -y, j -> +x
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(g.origin[i], s.geometry.origin[i], 1e-5);
            EXPECT_NEAR(g.spacing[i], s.geometry.spacing[i], 1e-6);
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(g.direction.row[i][j], expected.row[i][j], 1e-6);
        }
    }
}

TEST(VolumeNifti, WithoutOrientationTheAxesAreRas) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.sform = 0;
    const Geometry g = read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels)))).geometry;
    EXPECT_EQ(g.direction.row, (Matrix3{{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}}.row));
    EXPECT_EQ(g.origin, (Double3{0, 0, 0}));
    EXPECT_EQ(g.spacing, s.geometry.spacing);
}

TEST(VolumeNifti, ConvertsMetresAndMicrometres) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.units = 3;
    EXPECT_NEAR(read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels)))).geometry.spacing[2], 2e-3, 1e-9);
    f.units = 1 | 8; // metres and seconds
    EXPECT_NEAR(read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels)))).geometry.origin[2], 31e3, 1e-2);
    f.units = 5;
    const Voxels v = read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels))));
    EXPECT_NEAR(v.geometry.spacing[2], 2, 1e-6);
    EXPECT_THAT(v.notes, Contains(HasSubstr("unit of length 5")));
    f.units = 0;
    EXPECT_THAT(read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels)))).decisions, Contains(HasSubstr("no unit of length")));
}

TEST(VolumeNifti, ReadsTheChosenFrameOfATimeSeries) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.dim = {s.dims[0], s.dims[1], s.dims[2], 3};
    std::vector<std::int16_t> all;
    for (std::int16_t t = 0; t < 3; ++t)
        for (const auto v : s.voxels) all.push_back(static_cast<std::int16_t>(v + t));
    for (const std::string name : {"a.nii", "a.nii.gz"}) {
        const std::string bytes = nifti(s, f, bytes_of(all));
        write(folder / name, name == "a.nii" ? bytes : deflated(bytes));
        for (int t = 0; t < 3; ++t) {
            VolumeReadOptions options;
            options.frame = t;
            const Voxels v = read_volume(folder / name, options);
            ASSERT_EQ(v.dims, s.dims);
            EXPECT_EQ(v.frames, 3);
            for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], s.voxels[i] + t);
        }
        VolumeReadOptions options;
        for (const int t : {-1, 3}) {
            options.frame = t;
            expect_error([&] { read_volume(folder / name, options); }, {"frame", "has 3 frames"});
        }
    }
}

TEST(VolumeNifti, FindsEitherFileOfAPair) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.pair = true;
    write(folder / "a.hdr", nifti_header(s, f));
    expect_error([&] { read_volume(folder / "a.hdr"); }, {"voxels are missing", "a.img"});
    write(folder / "a.img.gz", deflated(bytes_of(s.voxels)));
    EXPECT_EQ(read_volume(folder / "a.hdr").dims, s.dims);
    EXPECT_EQ(read_volume(folder / "a.img.gz").dims, s.dims);
}

TEST(VolumeNifti, RefusesColoursLabelsAndOldFiles) {
    const Folder folder;
    const Sample s;
    const auto refused = [&](const std::function<void(NiftiFields&)>& change, const std::vector<std::string>& words) {
        NiftiFields f;
        change(f);
        expect_error([&] { read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels) + std::string(1000, '\0')))); }, words);
    };
    refused([](NiftiFields& f) { f.datatype = 128; }, {"RGB", "one channel"});
    refused([](NiftiFields& f) { f.datatype = 32; }, {"complex"});
    refused([](NiftiFields& f) { f.datatype = 7; }, {"data type 7"});
    refused([](NiftiFields& f) { f.intent = 1002; }, {"label map"});
    refused([](NiftiFields& f) { f.intent = 2003; }, {"RGB", "one channel"});
    refused([](NiftiFields& f) { f.dim = {5, 4, 3, 1, 1, 2}; }, {"5 x 4 x 3 x 1 x 1 x 2 x 1", "extract one volume"});
    refused([](NiftiFields& f) { f.dim = {5, 0, 3}; }, {"5 x 0 x 3"});
    refused([](NiftiFields& f) { f.dim = {5, -4, 3}; }, {"5 x -4 x 3"});
    refused([](NiftiFields& f) { f.voxel_offset = 352.5; }, {"start at byte 352.5"});
    refused([](NiftiFields& f) { f.voxel_offset = 1e9; }, {"truncated"});
    std::string analyze = nifti(s);
    analyze.replace(344, 4, std::string(4, '\0'));
    expect_error([&] { read_volume(write(folder / "a.nii", analyze)); }, {"ANALYZE"});
}

TEST(VolumeNifti, RefusesHostileSizesBeforeAllocating) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.version = 2;
    for (const auto& dims :
         {std::vector<std::int64_t>{1000000000, 1000000000, 1000000000}, {30000, 30000, 30000}, {INT64_MAX, INT64_MAX, 2}}) {
        f.dim = dims;
        expect_error([&] { read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels)))); }, {});
        expect_error([&] { read_volume(write(folder / "a.nii.gz", deflated(nifti(s, f, bytes_of(s.voxels))))); }, {});
    }
}

TEST(VolumeNifti, NotesBytesBehindTheVoxels) {
    const Folder folder;
    EXPECT_THAT(read_volume(write(folder / "a.nii", nifti(Sample()) + "12345")).notes, Contains(HasSubstr("5 bytes after the voxels")));
}

TEST(VolumeNifti, CountsNanAndInfiniteVoxelsAndShowsThemAsTheMinimum) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.datatype = 16, f.sample_bytes = 4;
    std::vector<float> values = samples_of<float>(s);
    values[3] = -5000;
    values[7] = NAN;
    values[8] = INFINITY;
    values[9] = -INFINITY;
    Voxels v = read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(values))));
    EXPECT_EQ(v.repaired, 3u);
    for (const int i : {7, 8, 9}) EXPECT_EQ(v.data<float>()[i], -5000);
    EXPECT_EQ(v.data<float>()[10], values[10]);
    EXPECT_THAT(v.notes, Contains(HasSubstr("3 voxels are NaN or infinite")));

    f.slope = -2; // the least physical value is the greatest stored one
    values[4] = 9000;
    v = read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(values))));
    EXPECT_EQ(v.data<float>()[7], 9000);

    std::fill(values.begin(), values.end(), NAN);
    expect_error([&] { read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(values)))); }, {"none of the 60 voxels is finite"});
}

TEST(VolumeNifti, DoublesBeyondFloatCountAsInfinite) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.datatype = 64, f.sample_bytes = 8;
    std::vector<double> values = samples_of<double>(s);
    values[5] = 1e300;
    EXPECT_EQ(read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(values)))).repaired, 1u);
}

} // namespace
} // namespace clvr::test
