// Volumes written as NIfTI and read again.
#include "host/io/volume/volume_file.hpp"
#include "runtime/error.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace clvr {
namespace {

Voxels oblique(VoxelType type) {
    Voxels v;
    v.type = type;
    v.dims = {7, 5, 3};
    v.bytes.resize(v.count() * voxel_bytes(type));
    for (std::size_t i = 0; i < v.bytes.size(); ++i) v.bytes[i] = static_cast<unsigned char>(i * 37 % (type == VoxelType::f32 ? 60 : 251));
    v.slope = 0.5;
    v.intercept = -1024;
    v.geometry.spacing = {0.5, 0.75, 2};
    v.geometry.origin = {10, -20, 30};
    const double c = std::cos(0.3), s = std::sin(0.3);
    v.geometry.direction = {{Double3{c, -s, 0}, Double3{s, c, 0}, Double3{0, 0, 1}}};
    return v;
}

TEST(VolumeWrite, ReadsBackAsItWas) {
    const TemporaryFolder folder;
    for (const VoxelType type : {VoxelType::u8, VoxelType::i8, VoxelType::u16, VoxelType::i16, VoxelType::f32})
        for (const char* ending : {".nii", ".nii.gz"}) {
            const Voxels v = oblique(type);
            const std::string path = (folder.path() / (std::string("v") + ending)).string();
            write_nifti(v, path);
            const Voxels back = read_volume(path, {});
            EXPECT_EQ(back.type, type);
            EXPECT_EQ(back.dims, v.dims);
            EXPECT_EQ(back.bytes, v.bytes) << voxel_type_name(type) << ending;
            EXPECT_EQ(back.slope, v.slope);
            EXPECT_EQ(back.intercept, v.intercept);
            for (const Double3& index : {Double3{0, 0, 0}, {6, 0, 0}, {0, 4, 0}, {3, 2, 2}})
                for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(back.geometry.to_world(index)[a], v.geometry.to_world(index)[a], 1e-5);
        }
}

TEST(VolumeWrite, RefusesOtherEndings) {
    const TemporaryFolder folder;
    EXPECT_THROW(write_nifti(oblique(VoxelType::u8), (folder.path() / "v.nrrd").string()), Error);
    EXPECT_THROW(write_nifti(oblique(VoxelType::u8), (folder.path() / "none" / "v.nii").string()), Error);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace clvr
