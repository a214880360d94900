// One suite over every volume format: what was written is read, damage is found.
#include "tests/io/volume_formats.hpp"

namespace clvr::test {
namespace {

class EveryFormat : public ::testing::TestWithParam<VolumeFormat> {};
class EveryChecksum : public ::testing::TestWithParam<VolumeFormat> {};

void expect_sample(const Voxels& v, const Sample& s, const VolumeFormat& f) {
    EXPECT_EQ(v.type, VoxelType::i16);
    ASSERT_EQ(v.dims, s.dims);
    ASSERT_EQ(v.bytes.size(), s.voxels.size() * 2);
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    EXPECT_EQ(v.slope, 1);
    EXPECT_EQ(v.intercept, 0);
    EXPECT_EQ(v.repaired, 0u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(v.geometry.spacing[i], f.keeps != VolumeFormat::no_geometry ? s.geometry.spacing[i] : 1, 1e-5);
        EXPECT_NEAR(v.geometry.origin[i], f.keeps < VolumeFormat::spacing_only ? s.geometry.origin[i] : 0, 1e-4);
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(v.geometry.direction.row[i][j], f.keeps == VolumeFormat::geometry ? s.geometry.direction.row[i][j] : i == j, 1e-5);
    }
}

TEST_P(EveryFormat, ReadsWhatWasWritten) {
    const Folder folder;
    const Sample s;
    const Voxels v = read_volume(GetParam().write(folder, s).path);
    expect_sample(v, s, GetParam());
    EXPECT_FALSE(v.format.empty());
}

TEST_P(EveryFormat, ReadsThinAndSingleVoxelVolumes) {
    for (const Int3 dims : {Int3{1, 1, 1}, Int3{1, 64, 48}, Int3{37, 1, 2}}) {
        const Folder folder;
        const Sample s(dims);
        const Voxels v = read_volume(GetParam().write(folder, s).path);
        ASSERT_EQ(v.dims, s.dims);
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    }
}

TEST_P(EveryFormat, RefusesATruncatedFile) {
    const Folder folder;
    const Written w = GetParam().write(folder, Sample());
    const std::string whole = read(w.payload);
    const std::size_t most = whole.size() - static_cast<std::size_t>(GetParam().spare);
    for (std::size_t i = 0; i <= 25; ++i) {
        const std::size_t size = most * i / 25;
        write(w.payload, whole.substr(0, size));
        EXPECT_FALSE(reads_or_throws(w.path)) << "read with " << size << " of " << whole.size() << " bytes";
    }
}

TEST_P(EveryFormat, SurvivesFlippedBits) {
    const Folder folder;
    const Sample s;
    const Written w = GetParam().write(folder, s);
    const std::string whole = read(w.payload);
    for (std::size_t i = 0; i < 40; ++i) {
        std::string damaged = whole;
        damaged[whole.size() * i / 40] ^= static_cast<char>(1 << (i % 8));
        write(w.payload, damaged);
        reads_or_throws(w.path);
    }
}

TEST_P(EveryChecksum, FindsFlippedVoxels) {
    const Folder folder;
    const Sample s;
    const Written w = GetParam().write(folder, s);
    const std::string whole = read(w.payload);
    const std::size_t first =
        whole.size() - deflated(bytes_of(s.voxels), false).size() / 2; // in the compressed voxels, whatever stands before
    for (std::size_t i = first; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] ^= 4;
        write(w.payload, damaged);
        EXPECT_FALSE(reads_or_throws(w.path)) << "byte " << i << " of " << whole.size();
    }
}

TEST_P(EveryFormat, RefusesAFrameThatIsNotThere) {
    const Folder folder;
    VolumeReadOptions options;
    options.frame = 3;
    expect_error([&] { read_volume(GetParam().write(folder, Sample()).path, options); }, {"frame 3"});
}

TEST_P(EveryFormat, NotesAConstantVolume) {
    const Folder folder;
    Sample s;
    std::fill(s.voxels.begin(), s.voxels.end(), std::int16_t{7});
    const Voxels v = read_volume(GetParam().write(folder, s).path);
    EXPECT_TRUE(
        std::any_of(v.notes.begin(), v.notes.end(), [](const std::string& n) { return n.find("same value, 7") != std::string::npos; }));
}

std::vector<VolumeFormat> with_checksum() {
    std::vector<VolumeFormat> formats = volume_formats();
    formats.erase(std::remove_if(formats.begin(), formats.end(), [](const VolumeFormat& f) { return !f.checksum; }), formats.end());
    return formats;
}

std::string name_of(const ::testing::TestParamInfo<VolumeFormat>& p) { return p.param.name; }
INSTANTIATE_TEST_SUITE_P(Volume, EveryChecksum, ::testing::ValuesIn(with_checksum()), name_of);
INSTANTIATE_TEST_SUITE_P(Volume, EveryFormat, ::testing::ValuesIn(volume_formats()),
                         [](const auto& p) { return std::string(p.param.name); });

} // namespace
} // namespace clvr::test
