// RAW: described by name, sidecar or options.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/volume_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(VolumeRaw, TakesTheNamesOfTheOpenSciVisDatasets) {
    const Folder folder;
    const Sample s;
    const Voxels v = read_volume(write(folder / "stag_beetle_5x4x3_int16.raw", bytes_of(s.voxels)));
    EXPECT_EQ(v.type, VoxelType::i16);
    EXPECT_EQ(v.dims, s.dims);
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    EXPECT_THAT(v.notes, Contains(HasSubstr("1 mm is assumed")));
    EXPECT_EQ(read_volume(write(folder / "x_3x2x1_uint8.raw", "abcdef")).type, VoxelType::u8);
    EXPECT_EQ(read_volume(write(folder / "x_3x2x1_float64.raw", std::string(48, '\1'))).type, VoxelType::f32);
}

TEST(VolumeRaw, NamesMayHoldBlanksSignsAndCapitals) {
    const Folder folder;
    const Sample s;
    for (const char* name : {"My scan 50%_5x4x3_int16.raw", "SCAN_5X4X3_INT16.RAW", "%d_5x4x3_Int16.Raw"})
        EXPECT_EQ(read_volume(write(folder / name, bytes_of(s.voxels))).dims, s.dims) << name;
    EXPECT_EQ(read_volume(write(folder / "A_5x4x3_int16.RAW.GZ", deflated(bytes_of(s.voxels)))).dims, s.dims);
    write(folder / "B 7%.json", R"({"dims": [5, 4, 3], "type": "int16"})");
    EXPECT_EQ(read_volume(write(folder / "B 7%.RAW", bytes_of(s.voxels))).dims, s.dims);
    EXPECT_EQ(read_volume(write(folder / "B 7%.RAW.GZ", deflated(bytes_of(s.voxels)))).dims, s.dims);
    EXPECT_EQ(read_volume(write(folder / "h_3x2x1_float16.raw", std::string("\0\x3c\0\xc1\0\0\0\0\0\0\0\0", 12))).data<float>()[1], -2.5f);
}

TEST(VolumeRaw, OtherNamesSayNothing) {
    const Folder folder;
    for (const char* name : {"a.raw", "_.raw", "5x4x3_int16.raw", "a_5x4_int16.raw", "a_5x4x3x2_int16.raw", "a_5x4xz_int16.raw",
                             "a_5x4x3_.raw", "a_int16.raw", "__.raw.gz"})
        expect_error([&] { read_volume(write(folder / name, bytes_of(Sample().voxels))); }, {"name_WxHxD_type.raw"});
}

TEST(VolumeRaw, SidecarAndOptionsSayMore) {
    const Folder folder;
    const Sample s;
    write(folder / "a.raw", bytes_of(s.voxels, true));
    expect_error([&] { read_volume(folder / "a.raw"); }, {"does not say its size", "--dims"});
    write(
        folder / "a.json",
        R"({"name": "A", "url": "none", "size": [5, 4, 3], "type": "int16", "endian": "big", "spacing": [1, 2, 3], "slope": 2, "intercept": -7, "modality": "CT"})");
    Voxels v = read_volume(folder / "a.raw");
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    EXPECT_EQ(v.geometry.spacing, (Double3{1, 2, 3}));
    EXPECT_EQ(v.slope, 2);
    EXPECT_EQ(v.intercept, -7);
    EXPECT_EQ(v.modality, "CT");
    VolumeReadOptions options;
    options.dims = Int3{4, 5, 3};
    options.spacing = Double3{3, 2, 1};
    options.endian = "little";
    options.type = "uint16";
    v = read_volume(folder / "a.raw", options);
    EXPECT_EQ(v.type, VoxelType::u16);
    EXPECT_EQ(v.dims, (Int3{4, 5, 3}));
    EXPECT_EQ(v.geometry.spacing, (Double3{3, 2, 1}));
    EXPECT_EQ(read_volume(write(folder / "any.bin", bytes_of(s.voxels)), options).dims, (Int3{4, 5, 3}));
}

TEST(VolumeRaw, SaysExpectedAndFoundBytes) {
    const Folder folder;
    const std::string voxels = bytes_of(Sample().voxels);
    expect_error([&] { read_volume(write(folder / "a_5x4x3_int16.raw", voxels.substr(1))); }, {"expected 120 bytes", "found 119"});
    expect_error([&] { read_volume(write(folder / "a_5x4x3_int16.raw", voxels + "x")); }, {"expected 120 bytes", "found 121"});
    expect_error([&] { read_volume(write(folder / "a_5x4x3_int16.raw.gz", deflated(voxels.substr(1)))); }, {"truncated", "119"});
    expect_error([&] { read_volume(write(folder / "a_5x4x3_int16.raw.gz", deflated(voxels + "x"))); }, {"expected 120 bytes", "found 121"});
    expect_error([&] { read_volume(write(folder / "a_900x900x900_int16.raw.gz", deflated(voxels))); }, {"found 120"});
    expect_error([&] { read_volume(write(folder / "a_1000000x1000000x1000000_uint8.raw", voxels)); }, {"found 120"});
}

TEST(VolumeRaw, RefusesWrongDescriptions) {
    const Folder folder;
    const std::string path = write(folder / "a.raw", bytes_of(Sample().voxels));
    const auto refused = [&](const std::string& sidecar, const std::vector<std::string>& words) {
        write(folder / "a.json", sidecar);
        expect_error([&] { read_volume(path); }, words);
    };
    refused(R"({"dims": [5, 4, 3], "type": "int17"})", {"int17"});
    refused(R"({"dims": [5, 4], "type": "int16"})", {"dims", "3 numbers"});
    refused(R"({"dims": [5, 4, 0], "type": "int16"})", {"dims"});
    refused(R"({"dims": [5, 4, 1e99], "type": "int16"})", {"dims"});
    refused(R"({"dims": [5, 4, 3], "type": "int16", "spacing": [1, 0, 1]})", {"spacing"});
    refused(R"({"dims": [5, 4, 3], "type": "int16", "direction": [1, 0, 0, 1, 0, 0, 0, 0, 1]})", {"singular"});
    refused(R"({"dims": [5, 4, 3], "type": "int16", "endian": "middle"})", {"middle"});
    refused(R"({"dims": [5, 4, 3], "type": 16})", {"type"});
    refused(R"({"dims": [5, 4, 3], "type": "int16", "slope": 0})", {"slope 0"});
    refused("[1, 2", {"JSON"});
}

} // namespace
} // namespace clvr::test
