// NumPy .npy: types, orders, versions, axes, and what is refused.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/numpy_writers.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// An array of shape (1, 1, 2) of the given bytes.
std::vector<double> two(const Folder& folder, const std::string& descr, const std::string& bytes) {
    return values_of(read_volume(write(folder / "a.npy", numpy_header("'" + descr + "'", "(1, 1, 2)") + bytes)));
}

TEST(VolumeNumpy, ReadsEveryTypeInBothByteOrders) {
    const Folder folder;
    EXPECT_THAT(two(folder, "|b1", std::string("\1\0", 2)), ElementsAre(1, 0));
    EXPECT_THAT(two(folder, "|u1", "\xfe\x01"), ElementsAre(254, 1));
    EXPECT_THAT(two(folder, "|i1", "\xfe\x01"), ElementsAre(-2, 1));
    for (const bool big : {false, true}) {
        const std::string order = big ? ">" : "<";
        EXPECT_THAT(two(folder, order + "u2", bytes_of(std::vector<std::uint16_t>{65535, 3}, big)), ElementsAre(65535, 3));
        EXPECT_THAT(two(folder, order + "i2", bytes_of(std::vector<std::int16_t>{-300, 3}, big)), ElementsAre(-300, 3));
        EXPECT_THAT(two(folder, order + "u4", bytes_of(std::vector<std::uint32_t>{70000, 3}, big)), ElementsAre(70000, 3));
        EXPECT_THAT(two(folder, order + "i4", bytes_of(std::vector<std::int32_t>{-70000, 3}, big)), ElementsAre(-70000, 3));
        EXPECT_THAT(two(folder, order + "u8", bytes_of(std::vector<std::uint64_t>{70000, 3}, big)), ElementsAre(70000, 3));
        EXPECT_THAT(two(folder, order + "i8", bytes_of(std::vector<std::int64_t>{-70000, 3}, big)), ElementsAre(-70000, 3));
        EXPECT_THAT(two(folder, order + "f4", bytes_of(std::vector<float>{-0.5f, 3}, big)), ElementsAre(-0.5, 3));
        EXPECT_THAT(two(folder, order + "f8", bytes_of(std::vector<double>{-0.5, 3}, big)), ElementsAre(-0.5, 3));
        // binary16: 1 sign, 5 exponent, 10 fraction bits
        EXPECT_THAT(two(folder, order + "f2", bytes_of(std::vector<std::uint16_t>{0xc100, 0x3555}, big)),
                    ElementsAre(-2.5, 0.333251953125));
        EXPECT_THAT(two(folder, order + "f2", bytes_of(std::vector<std::uint16_t>{0x0001, 0x7bff}, big)),
                    ElementsAre(std::ldexp(1, -24), 65504));
        EXPECT_THAT(two(folder, order + "f2", bytes_of(std::vector<std::uint16_t>{0x7c00, 0x3c00}, big)), ElementsAre(1, 1)); // infinite
    }
}

TEST(VolumeNumpy, FortranOrderMovesBytesNotIndices) {
    const Folder folder;
    std::vector<std::int16_t> stored; // index (z, y, x) of (2, 3, 4), z fastest
    for (std::int16_t x = 0; x < 4; ++x)
        for (std::int16_t y = 0; y < 3; ++y)
            for (std::int16_t z = 0; z < 2; ++z) stored.push_back(static_cast<std::int16_t>(100 * z + 10 * y + x));
    const Voxels v = read_volume(write(folder / "a.npy", numpy_header("'<i2'", "(2, 3, 4)", true) + bytes_of(stored)));
    ASSERT_EQ(v.dims, (Int3{4, 3, 2}));
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 4; ++x) EXPECT_EQ(v.data<std::int16_t>()[(z * 3 + y) * 4 + x], 100 * z + 10 * y + x);
    EXPECT_THAT(v.decisions, Contains(HasSubstr("(z, y, x)")));
}

TEST(VolumeNumpy, ReadsEveryVersionAndPythonTwosShapes) {
    const Folder folder;
    const Sample s;
    for (const int version : {1, 2, 3}) {
        const Voxels v = read_volume(write(folder / "a.npy", numpy(s, version)));
        EXPECT_EQ(v.dims, s.dims);
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
        EXPECT_THAT(v.notes, Contains(HasSubstr("1 mm is assumed")));
    }
    EXPECT_EQ(read_volume(write(folder / "b.npy", numpy_header("'<i2'", "(3L, 4L, 5L)") + bytes_of(s.voxels))).dims, s.dims);
    expect_error([&] { read_volume(write(folder / "c.npy", numpy(s, 4))); }, {"version 4"});
}

TEST(VolumeNumpy, TakesAFourthAxisInFrontForTimes) {
    const Folder folder;
    for (const bool fortran : {false, true}) {
        std::vector<std::int16_t> stored; // (t, z, y, x) of (2, 5, 6, 7)
        for (int n = 0; n < 2 * 5 * 6 * 7; ++n) {
            int at = n;
            int index[4];
            const int size[4] = {2, 5, 6, 7};
            for (int k = 0; k < 4; ++k) {
                const int axis = fortran ? k : 3 - k;
                index[axis] = at % size[axis];
                at /= size[axis];
            }
            stored.push_back(static_cast<std::int16_t>(1000 * index[0] + 100 * index[1] + 10 * index[2] + index[3]));
        }
        write(folder / "a.npy", numpy_header("'<i2'", "(2, 5, 6, 7)", fortran) + bytes_of(stored));
        for (int t = 0; t < 2; ++t) {
            VolumeReadOptions options;
            options.frame = t;
            const Voxels v = read_volume(folder / "a.npy", options);
            ASSERT_EQ(v.dims, (Int3{7, 6, 5}));
            EXPECT_EQ(v.data<std::int16_t>()[(3 * 6 + 4) * 7 + 5], 1000 * t + 345);
            EXPECT_THAT(v.decisions, Contains(HasSubstr(fmt::format("frame {} of 0 to 1", t))));
        }
    }
}

TEST(VolumeNumpy, ASliceIsAVolumeOfOneAndAxesOfOneSayNothing) {
    const Folder folder;
    const Sample s({6, 10, 1});
    EXPECT_EQ(read_volume(write(folder / "a.npy", numpy_header("'<i2'", "(10, 6)") + bytes_of(s.voxels))).dims, (Int3{6, 10, 1}));
    EXPECT_EQ(read_volume(write(folder / "a.npy", numpy_header("'<i2'", "(1, 1, 2, 5, 6, 1)") + bytes_of(s.voxels))).dims, (Int3{6, 5, 2}));
}

TEST(VolumeNumpy, TakesTheSpacingGiven) {
    const Folder folder;
    VolumeReadOptions options;
    options.spacing = Double3{0.5, 1, 2};
    const Voxels v = read_volume(write(folder / "a.npy", numpy(Sample())), options);
    EXPECT_EQ(v.geometry.spacing, (Double3{0.5, 1, 2}));
    EXPECT_TRUE(v.notes.empty());
}

TEST(VolumeNumpy, RefusesWhatIsNoArrayOfNumbers) {
    const Folder folder;
    const auto refused = [&](const std::string& descr, const std::string& shape, const std::vector<std::string>& words) {
        expect_error([&] { read_volume(write(folder / "a.npy", numpy_header(descr, shape) + std::string(4000, '\1'))); }, words);
    };
    refused("[('a', '<f4'), ('b', '<i2')]", "(2, 3, 4)", {"records"});
    refused("'<c8'", "(2, 3, 4)", {"complex", "magnitude"});
    refused("'|O'", "(2, 3, 4)", {"objects"});
    refused("'<M8[ns]'", "(2, 3, 4)", {"dates"});
    refused("'<m8[s]'", "(2, 3, 4)", {"time differences"});
    refused("'<U5'", "(2, 3, 4)", {"texts"});
    refused("'|V8'", "(2, 3, 4)", {"records"});
    refused("'<f16'", "(2, 3, 4)", {"more than 64 bits"});
    refused("'<i3'", "(2, 3, 4)", {"<i3"});
    refused("'<i2'", "()", {"shape ()"});
    refused("'<i2'", "(24,)", {"shape (24)"});
    refused("'<i2'", "(2, 2, 2, 2, 2)", {"shape (2, 2, 2, 2, 2)"});
    refused("'<i2'", "(8, 8, 8, 3)", {"channels", "[..., 0]"});
    refused("'<i2'", "(2, 0, 4)", {"shape"});
    refused("'<i2'", "(2, -3, 4)", {"shape"});
    refused("'<i2'", "(2000, 2000, 2000)", {"at most"});
    refused("'<i2'", "(2000000, 2000000, 2000000)", {"impossible"});
    expect_error([&] { read_volume(write(folder / "a.npy", std::string("\x93NUMPY\1\0\x08\0nothing!", 18))); }, {"dictionary"});
    expect_error([&] { read_volume(write(folder / "a.npy", std::string("\x93NUMPY\2\0\xff\xff\xff\xff{}", 14))); }, {"4294967295"});
}

} // namespace
} // namespace clvr::test
