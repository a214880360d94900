// Voxel types and the histogram of stored values.
#include "host/volume/voxels.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace clvr {
namespace {

template <class T>
Voxels volume_of(VoxelType type, Int3 dims, const std::vector<T>& values) {
    Voxels v;
    v.type = type;
    v.dims = dims;
    v.bytes.resize(values.size() * sizeof(T));
    std::memcpy(v.bytes.data(), values.data(), v.bytes.size());
    return v;
}

TEST(Voxels, TypeNames) {
    const char* const names[] = {"u8", "i8", "u16", "i16", "f32"};
    for (int t = 0; t < 5; ++t) EXPECT_STREQ(voxel_type_name(static_cast<VoxelType>(t)), names[t]);
}

TEST(StoredHistogram, CountsEveryVoxelOnceInEveryType) {
    constexpr int n = 3 * 5 * 7;
    std::vector<double> values;
    for (int i = 0; i < n; ++i) values.push_back((i * 37) % 101 - 20);
    const auto check = [&](auto zero, VoxelType type, double shift) {
        using T = decltype(zero);
        std::vector<T> typed;
        for (const double x : values) typed.push_back(static_cast<T>(x + shift));
        const Histogram h = stored_histogram(volume_of(type, {3, 5, 7}, typed));
        EXPECT_EQ(h.low, shift - 20);
        EXPECT_EQ(h.high, shift + 80);
        ASSERT_EQ(h.bins.size(), 1024u);
        EXPECT_EQ(h.total(), static_cast<std::uint64_t>(n));
        std::vector<std::uint64_t> expected(1024);
        for (const double x : values) ++expected[std::min<std::size_t>(static_cast<std::size_t>((x + 20) * 1024 / 100), 1023)];
        EXPECT_EQ(h.bins, expected);
    };
    check(std::uint8_t{}, VoxelType::u8, 100);
    check(std::int8_t{}, VoxelType::i8, 0);
    check(std::uint16_t{}, VoxelType::u16, 60000);
    check(std::int16_t{}, VoxelType::i16, -30000);
    check(float{}, VoxelType::f32, 0.5);
}

TEST(StoredHistogram, TakesTheExtremesOfATypeAndConstantVolumes) {
    const Histogram extreme = stored_histogram(volume_of<std::int16_t>(VoxelType::i16, {2, 1, 1}, {-32768, 32767}));
    EXPECT_EQ(extreme.low, -32768);
    EXPECT_EQ(extreme.high, 32767);
    EXPECT_EQ(extreme.bins.front(), 1u);
    EXPECT_EQ(extreme.bins.back(), 1u);
    const float most = std::numeric_limits<float>::max();
    const Histogram wide = stored_histogram(volume_of<float>(VoxelType::f32, {1, 1, 3}, {-most, 0, most}));
    EXPECT_EQ(wide.total(), 3u);
    EXPECT_EQ(wide.bins[512], 1u);
    const Histogram constant = stored_histogram(volume_of<std::uint8_t>(VoxelType::u8, {1, 1, 4}, {9, 9, 9, 9}));
    EXPECT_EQ(constant.low, 9);
    EXPECT_EQ(constant.high, 9);
    EXPECT_EQ(constant.bins[0], 4u);
}

} // namespace
} // namespace clvr
