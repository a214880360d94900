#include "host/render/surface_lobe.hpp"
#include "tests/reference/scatter.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

TEST(SurfaceLobe, HoldsTheGlossyAlbedoAndItsMean) {
    const std::vector<float> table = surface_lobe_table();
    ASSERT_EQ(table.size(), 34u);
    double worst = 0;
    for (int k = 1; k <= 32; ++k) worst = std::max(worst, std::abs(table[k] - reference::glossy_albedo(k / 32.0)));
    EXPECT_LE(worst, 3e-4);
    double mean = 0; // twice the integral of cosine times albedo, by midpoints of the interpolated table
    for (int i = 0; i < 3200; ++i) {
        const double x = (i + 0.5) / 100;
        const int k = static_cast<int>(x);
        mean += 2 * (x / 32) * (table[k] + (x - k) * (table[k + 1] - table[k])) / 3200;
    }
    EXPECT_NEAR(table[33], mean, 1e-5);
}

} // namespace
} // namespace clvr
