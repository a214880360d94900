// The fixture of the tests of one format with a text header.
#pragma once
#include "host/io/volume/volume_file.hpp"
#include "tests/io/text_header_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {

class VolumeHeader : public ::testing::Test {
protected:
    Folder folder;
    Sample s;
    std::string voxels = bytes_of(s.voxels);

    Voxels read(const std::string& name, const std::string& bytes, const VolumeReadOptions& options = {}) {
        return read_volume(write(folder / name, bytes), options);
    }
    void refused(const std::string& name, const std::string& bytes, const std::vector<std::string>& words,
                 const VolumeReadOptions& options = {}) {
        SCOPED_TRACE(words.empty() ? name : words.front());
        expect_error([&] { read(name, bytes, options); }, words);
    }
    /// The sample's voxels, each plus `more`.
    void expect_voxels(const Voxels& v, int more = 0) {
        ASSERT_EQ(v.type, VoxelType::i16);
        ASSERT_EQ(v.dims, s.dims);
        for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], s.voxels[i] + more) << i;
    }
    /// The sample's voxels plus 0, 1, ... for each of `count` entries of an axis beside space: the fastest axis or the slowest.
    std::string several(int count, bool fastest) {
        std::vector<std::int16_t> all;
        const auto put = [&](std::int16_t v, int c) { all.push_back(static_cast<std::int16_t>(v + c)); };
        if (fastest)
            for (const auto v : s.voxels)
                for (int c = 0; c < count; ++c) put(v, c);
        else
            for (int c = 0; c < count; ++c)
                for (const auto v : s.voxels) put(v, c);
        return bytes_of(all);
    }
    static VolumeReadOptions frame(int n) {
        VolumeReadOptions o;
        o.frame = n;
        return o;
    }
    static VolumeReadOptions channel(int n) {
        VolumeReadOptions o;
        o.channel = n;
        return o;
    }
    static VolumeReadOptions array(const std::string& name) {
        VolumeReadOptions o;
        o.array = name;
        return o;
    }
    static void expect_near(const Double3& found, const Double3& expected) {
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-9 * (1 + std::abs(expected[i]))) << i;
    }
    static void expect_direction(const Voxels& v, const std::array<Double3, 3>& rows) {
        for (std::size_t i = 0; i < 3; ++i) expect_near(v.geometry.direction.row[i], rows[i]);
    }
};

} // namespace clvr::test
