// NIfTI files that sound readers take although a part of their header is not usable: another part is taken, and that is said.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/volume_writers.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

/// The sample's file with changed fields; `matrix` false: all of the sform's numbers are 0.
std::string file_of(const NiftiFields& f, bool matrix = true) {
    const Sample s;
    std::string bytes = nifti(s, f, bytes_of(s.voxels, f.big));
    if (!matrix) bytes.replace(280, 48, std::string(48, '\0'));
    return bytes;
}
Voxels read_as(const Folder& folder, const NiftiFields& f, bool matrix = true) {
    return read_volume(write(folder / "a.nii", file_of(f, matrix)));
}
void expect_sform(const Geometry& g) {
    const Sample s;
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(g.spacing[i], s.geometry.spacing[i], 1e-6);
        EXPECT_NEAR(g.origin[i], s.geometry.origin[i], 1e-5);
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(g.direction.row[i][j], s.geometry.direction.row[i][j], 1e-6);
    }
}
/// The quaternion of no rotation: in LPS the first two axes point the other way.
void expect_qform(const Geometry& g) {
    const Sample s;
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(g.spacing[i], s.geometry.spacing[i], 1e-6);
        EXPECT_NEAR(g.origin[i], s.geometry.origin[i], 1e-5);
    }
    EXPECT_EQ(g.direction.row, (Matrix3{{{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}}.row));
}

TEST(VolumeNiftiForms, AnUnusableSformGivesWayToTheQform) {
    const Folder folder;
    NiftiFields f;
    f.qform = 1;
    const Voxels zeros = read_as(folder, f, false);
    expect_qform(zeros.geometry);
    EXPECT_THAT(zeros.notes, Contains(HasSubstr("sform is not usable (a column of zeros): the qform is taken")));

    Sample s;
    s.geometry.direction.row = {{{1, 1, 0}, {0, 0, 0}, {0, 0, 1}}}; // two axes in one
    const Voxels flat = read_volume(write(folder / "b.nii", nifti(s, f, bytes_of(s.voxels))));
    expect_qform(flat.geometry);
    EXPECT_THAT(flat.notes, Contains(HasSubstr("sform is not usable (singular)")));

    s.geometry.direction.row[1][1] = nan;
    EXPECT_THAT(read_volume(write(folder / "c.nii", nifti(s, f, bytes_of(s.voxels)))).notes, Contains(HasSubstr("not finite")));
}

TEST(VolumeNiftiForms, WithoutAnyFormTheVoxelSizesAreTaken) {
    const Folder folder;
    NiftiFields f; // no qform
    const Voxels v = read_as(folder, f, false);
    EXPECT_EQ(v.geometry.spacing, Sample().geometry.spacing);
    EXPECT_EQ(v.geometry.origin, (Double3{0, 0, 0}));
    EXPECT_THAT(v.notes, Contains(HasSubstr("voxel sizes (pixdim) alone")));
    f.qform = 1;
    f.quatern = {2, 0, 0};
    const Voxels both = read_as(folder, f, false);
    EXPECT_EQ(both.geometry.spacing, Sample().geometry.spacing);
    EXPECT_THAT(both.notes, Contains(AllOf(HasSubstr("the sform is not usable"), HasSubstr("quaternion 2 0 0 is longer than 1"))));
    f.pixdim = {0.5, 0, 2};
    write(folder / "a.nii", file_of(f, false));
    expect_error([&] { read_volume(folder / "a.nii"); }, {"0.5 x 0 x 2 (pixdim)", "sform is not usable"});
    f.qform = 0;
    write(folder / "a.nii", file_of(f, false));
    expect_error([&] { read_volume(folder / "a.nii"); }, {"0.5 x 0 x 2 (pixdim)"});
}

TEST(VolumeNiftiForms, AQuaternionALittleTooLongIsARotation) {
    const Folder folder;
    NiftiFields f;
    f.sform = 0, f.qform = 1;
    f.quatern = {0, 0, 1.001}; // half a turn about z
    const Voxels v = read_as(folder, f);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(v.geometry.direction.row[i][j], i == j, 1e-6);
    EXPECT_THAT(v.decisions, Contains(HasSubstr("length 1")));
}

TEST(VolumeNiftiForms, AnUnusableQformGivesWayToTheMatrix) {
    const Folder folder;
    NiftiFields f;
    f.sform = 0, f.qform = 1;
    f.quatern = {2, 0, 0};
    const Voxels v = read_as(folder, f);
    expect_sform(v.geometry);
    EXPECT_THAT(v.notes, Contains(AllOf(HasSubstr("quaternion 2 0 0"), HasSubstr("matrix of the sform"))));
}

TEST(VolumeNiftiForms, VoxelSizesThatAreNoneGiveWayToTheMatrix) {
    const Folder folder;
    for (const double bad : {0.0, nan, infinite})
        for (const int version : {1, 2}) {
            NiftiFields f;
            f.version = version;
            f.pixdim = {bad, bad, bad};
            const Voxels v = read_as(folder, f);
            expect_sform(v.geometry);
            EXPECT_THAT(v.notes, Contains(HasSubstr("(pixdim) is not usable: the spacing is that of the sform")));
            f.qform = 1;
            EXPECT_TRUE(read_as(folder, f).decisions.empty()); // no qform without sizes: none that disagrees
            f.sform = f.qform = 0;
            const Voxels undeclared = read_as(folder, f);
            expect_sform(undeclared.geometry);
            EXPECT_THAT(undeclared.notes, Contains(HasSubstr("though its code is 0")));
        }
}

TEST(VolumeNiftiForms, AnAxisOfOneVoxelNeedsNoSize) {
    const Folder folder;
    const Sample s({5, 4, 1});
    NiftiFields f;
    f.sform = 0;
    f.pixdim = {0.5, 0.75, 0};
    const Voxels v = read_volume(write(folder / "a.nii", nifti(s, f, bytes_of(s.voxels))));
    EXPECT_EQ(v.geometry.spacing, (Double3{0.5, 0.75, 1}));
    EXPECT_THAT(v.notes, Contains(HasSubstr("1 mm along an axis of one voxel")));
}

TEST(VolumeNiftiForms, WhereFormsDisagreeTheSformIsTakenAndShown) {
    const Folder folder;
    NiftiFields f;
    f.qform = 1;
    const Voxels v = read_as(folder, f);
    expect_sform(v.geometry);
    EXPECT_THAT(v.decisions, Contains("sform and qform disagree: the sform is taken"));
    EXPECT_TRUE(v.notes.empty());
    // RAS 30 degrees about z from axes that point to L and P
    f.quatern = {0, 0, -std::sin((180 + 30) * M_PI / 360)}; // its first part, the cosine, is not below 0
    EXPECT_TRUE(read_as(folder, f).decisions.empty());
}

TEST(VolumeNiftiForms, NumbersOfAxesThatAreNoneAreCounted) {
    const Folder folder;
    const Sample s;
    const auto with_axes = [&](std::int16_t axes, std::vector<std::int64_t> dim) {
        NiftiFields f;
        f.dim = std::move(dim);
        std::string bytes = nifti(s, f, bytes_of(s.voxels));
        return write(folder / "a.nii", bytes.replace(40, 2, number(axes)));
    };
    for (const std::int16_t axes : {0, 9, -1}) {
        const Voxels v = read_volume(with_axes(axes, {5, 4, 3}));
        EXPECT_EQ(v.dims, s.dims);
        EXPECT_THAT(v.notes, Contains(HasSubstr(fmt::format("says {} dimensions", axes))));
    }
    expect_error([&] { read_volume(with_axes(0, {5, 4, 0})); }, {"0 dimensions"});
    const Voxels zero = read_volume(with_axes(4, {5, 4, 3, 0}));
    EXPECT_EQ(zero.dims, s.dims);
    EXPECT_THAT(zero.decisions, Contains(HasSubstr("size 0 of axis 4")));
    EXPECT_EQ(read_volume(with_axes(3, {5, 4, 3, 0, 0, 0, 0})).dims, s.dims);
    EXPECT_EQ(read_volume(with_axes(5, {5, 4, 3, 1, 1})).dims, s.dims);
}

TEST(VolumeNiftiForms, TheFifthAxisHoldsChannels) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.dim = {5, 4, 3, 2, 3};
    f.intent = 1007; // a vector
    std::vector<std::int16_t> all;
    for (std::int16_t n = 0; n < 6; ++n)
        for (const auto v : s.voxels) all.push_back(static_cast<std::int16_t>(v + n));
    write(folder / "a.nii", nifti(s, f, bytes_of(all)));
    EXPECT_THAT(read_volume(folder / "a.nii").notes, Contains(HasSubstr("3 channels: the first is taken")));
    VolumeReadOptions options;
    options.frame = 1;
    options.channel = 2;
    const Voxels v = read_volume(folder / "a.nii", options);
    EXPECT_TRUE(v.notes.empty());
    for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], s.voxels[i] + 5);
    options.channel = 3;
    expect_error([&] { read_volume(folder / "a.nii", options); }, {"channel 3", "3 channels"});
}

TEST(VolumeNiftiForms, AnOffsetWithinTheHeaderMeansBehindIt) {
    const Folder folder;
    const Sample s;
    for (const int version : {1, 2})
        for (const double offset : {0.0, 20.0, 348.0}) {
            NiftiFields f;
            f.version = version;
            f.voxel_offset = offset;
            for (const bool gzip : {false, true}) {
                const std::string bytes = nifti(s, f, bytes_of(s.voxels));
                const Voxels v = read_volume(write(folder / "a.nii", gzip ? deflated(bytes) : bytes));
                EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>())) << offset;
                EXPECT_THAT(v.notes, Contains(HasSubstr(fmt::format("byte {} is taken", version == 2 ? 544 : 352))));
            }
        }
    NiftiFields f; // some writers leave out the four bytes behind the header
    for (const double offset : {0.0, 348.0}) {
        f.voxel_offset = offset;
        const Voxels v = read_volume(write(folder / "b.nii", nifti_header(s, f) + bytes_of(s.voxels)));
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>())) << offset;
        const Voxels packed = read_volume(write(folder / "b.nii.gz", deflated(nifti_header(s, f) + bytes_of(s.voxels))));
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), packed.data<std::int16_t>())) << offset;
    }
}

TEST(VolumeNiftiForms, ExtensionsAndBytesBehindGzipArePassedOver) {
    const Folder folder;
    const Sample s;
    NiftiFields f;
    f.voxel_offset = 352 + 32;
    const std::string bytes = nifti_header(s, f) + std::string("\1\0\0\0", 4) + number(std::int32_t{32}) + number(std::int32_t{6}) +
                              std::string(24, 'c') + bytes_of(s.voxels);
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), read_volume(write(folder / "a.nii", bytes)).data<std::int16_t>()));
    EXPECT_TRUE(read_volume(write(folder / "b.nii.gz", deflated(nifti(s)) + "tail")).notes.empty());
}

TEST(VolumeNiftiForms, BytesDecideBeforeNames) {
    const Folder folder;
    const Sample s;
    NiftiFields pair;
    pair.pair = true;
    EXPECT_EQ(read_volume(write(folder / "single.img", nifti(s))).dims, s.dims);
    EXPECT_EQ(read_volume(write(folder / "packed.IMG.gz", deflated(nifti(s)))).dims, s.dims);
    EXPECT_EQ(read_volume(write(folder / "single.hdr", nifti(s))).dims, s.dims);
    // the mark of a pair, though the file is whole
    const Voxels v = read_volume(write(folder / "whole.nii", nifti_header(s, pair) + bytes_of(s.voxels)));
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    EXPECT_THAT(v.decisions, Contains(HasSubstr("taken from this file")));
    EXPECT_EQ(read_volume(write(folder / "x.img", nrrd_header(s, "raw") + "\n" + bytes_of(s.voxels))).format, "NRRD");
    expect_error([&] { read_volume(write(folder / "alone.img", bytes_of(s.voxels))); }, {"its header is missing", ".hdr"});
}

TEST(VolumeNiftiForms, PairsAreFoundInAnyCase) {
    const Sample s;
    NiftiFields f;
    f.pair = true;
    for (const auto& [header, voxels] :
         {std::pair{"P.HDR", "P.IMG"}, {"P.hdr", "P.IMG"}, {"p.hdr", "P.img"}, {"P 50%.Hdr", "P 50%.img.GZ"}, {"P.HDR.GZ", "P.IMG"}}) {
        const Folder folder;
        const auto packed = [](const std::string& name) { return name.back() == 'Z'; };
        const std::string h = nifti_header(s, f), b = bytes_of(s.voxels);
        write(folder / header, packed(header) ? deflated(h) : h);
        write(folder / voxels, packed(voxels) ? deflated(b) : b);
        for (const char* name : {header, voxels}) {
            const Voxels v = read_volume(folder / name);
            EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>())) << name;
        }
    }
    // where several differ only by case, the one that agrees
    const Folder folder;
    Sample other = s;
    for (auto& v : other.voxels) v = static_cast<std::int16_t>(v + 1);
    write(folder / "p.hdr", nifti_header(s, f)), write(folder / "p.img", bytes_of(s.voxels));
    write(folder / "P.hdr", nifti_header(s, f)), write(folder / "P.img", bytes_of(other.voxels));
    EXPECT_EQ(read_volume(folder / "P.hdr").data<std::int16_t>()[0], other.voxels[0]);
    EXPECT_EQ(read_volume(folder / "p.hdr").data<std::int16_t>()[0], s.voxels[0]);
}

} // namespace
} // namespace clvr::test
