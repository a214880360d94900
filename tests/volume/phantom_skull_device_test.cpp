// The computed bare skull: bones, teeth, ring artefacts.
#include "host/phantom/parts.hpp"
#include "tests/volume/computed_volume.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

using namespace testing;

TEST(Skull, IsBareAndHollow) {
    Device device = open_device();
    for (const std::uint64_t seed : {0, 1, 2}) {
        const Voxels v = make_phantom(device, "skull", {Int3{128, 173, 192}, VoxelType::i16, seed});
        EXPECT_GT(greatest(v, {-20, 10, 100}, {-20, 10, 132}), 800) << seed;     // the vault,
        EXPECT_LT(greatest(v, {-20, 0, 20}, {-20, 0, 80}), -800) << seed;        // nothing in it
        EXPECT_LT(greatest(v, {-32, -66, 10}, {-32, -110, 12}), -800) << seed;   // nor in the orbits
        EXPECT_GT(greatest(v, {-54, -26, -4.5}, {-76, -26, -4.5}), 400) << seed; // cheek bones
        EXPECT_NEAR(greatest(v, {0, 30, -80}, {0, 30, -60}), 140, 90) << seed;   // the pole
        EXPECT_NEAR(above(v, 600), 0.065, 0.02) << seed;
        EXPECT_NEAR(above(v, 1800), 0.0013, 0.001) << seed; // enamel and wires
    }
}

TEST(Skull, LosesTeethByItsSeed) {
    std::vector<std::size_t> teeth;
    for (std::uint64_t seed = 0; seed < 6; ++seed) teeth.push_back(skull_volume(seed).bodies[shared::CLVR_SKULL_TEETH].parts.size() / 2);
    EXPECT_GE(*std::min_element(teeth.begin(), teeth.end()), 7u);
    EXPECT_LE(*std::max_element(teeth.begin(), teeth.end()), 14u);
    EXPECT_NE(*std::min_element(teeth.begin(), teeth.end()), *std::max_element(teeth.begin(), teeth.end()));
}

/// Variance between the means of rings one voxel wide around (x, y) in the slices z0..z1, over radii of 6 to 50 voxels, of values below
/// -900.
double ring_variance(const Voxels& v, double x, double y, int z0, int z1) {
    std::vector<double> sum(60), n(60);
    for (int z = z0; z < z1; ++z)
        for (int j = 0; j < v.dims[1]; ++j)
            for (int i = 0; i < v.dims[0]; ++i) {
                const double r = std::sqrt((i - x) * (i - x) + (j - y) * (j - y)), hu = at(v, i, j, z);
                if (r >= 6 && r < 50 && hu < -900) sum[static_cast<std::size_t>(r)] += hu, n[static_cast<std::size_t>(r)] += 1;
            }
    double mean = 0, square = 0, count = 0;
    for (std::size_t k = 0; k < sum.size(); ++k)
        if (n[k] > 0) mean += sum[k] / n[k], square += sum[k] / n[k] * (sum[k] / n[k]), count += 1;
    return square / count - mean / count * (mean / count);
}

TEST(Skull, HasRingsAroundTheScannersAxis) {
    Device device = open_device();
    const Voxels v = make_phantom(device, "skull", {Int3{160, 216, 240}, VoxelType::i16});
    const Double3 axis = v.geometry.to_index({0, 0, 0});
    // Inside of the empty braincase.
    const double here = ring_variance(v, axis[0], axis[1], 140, 146);
    for (const auto& [dx, dy] : {std::pair{4, 0}, {-4, 0}, {0, 4}, {0, -4}})
        EXPECT_GT(here, 4 * ring_variance(v, axis[0] + dx, axis[1] + dy, 140, 146)) << dx << " " << dy;
    EXPECT_GT(here, 15); // faint, but there
    EXPECT_LT(here, 900);
}

} // namespace
} // namespace clvr
