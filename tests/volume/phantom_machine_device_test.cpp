// The computed machine part: materials, cupping, threads.
#include "host/phantom/parts.hpp"
#include "tests/volume/computed_volume.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

using namespace testing;

TEST(Machine, HasAluminiumAndSteel) {
    Device device = open_device();
    for (const std::uint64_t seed : {0, 1, 2, 3}) {
        const Voxels v = make_phantom(device, "machine", {Int3{128, 128, 98}, {}, seed});
        EXPECT_EQ(v.type, VoxelType::u16);
        EXPECT_NEAR(above(v, 0), 0.115, 0.03) << seed;
        EXPECT_NEAR(above(v, 1900), 0.015, 0.008) << seed;
        EXPECT_GT(hounsfield(v, {0, 0, 10}), 2000) << seed;   // the shaft,
        EXPECT_GT(hounsfield(v, {-30, 0, -27}), 700) << seed; // the plate with
        EXPECT_LT(hounsfield(v, {-30, 0, -27}), 1400) << seed;
        EXPECT_NEAR(hounsfield(v, {-45, -45, 30}), -1000, 20) << seed; // air around
    }
}

TEST(Machine, CupsTowardsTheAxis) {
    Device device = open_device();
    const Voxels v = make_phantom(device, "machine", {Int3{200, 200, 152}});
    // The plate between housing and screws, near the axis and far from it.
    EXPECT_GT(hounsfield(v, {-36, 0, -27}), hounsfield(v, {-25, 0, -27}) + 60);
}

TEST(Machine, TurnsThreadsThatRepeatAlongTheAxis) {
    // Eight voxels a pitch along z.
    constexpr double pitch = 1.6, step = pitch / 8;
    Device device = open_device();
    const MadeVolume made = machine_volume(5);
    const Voxels v = make_phantom(device, "machine", {Int3{500, 500, static_cast<int>(made.box_size[2] / step + 0.5)}, VoxelType::i16, 5});
    int screws = 0;
    for (const shared::PhantomPart& part : made.bodies[shared::CLVR_MACHINE_STEEL].parts) {
        if (part.kind != CLVR_PART_CYLINDER || std::abs(static_cast<double>(part.c.w) - pitch) > 1e-6) continue;
        ++screws;
        // Down from below the plate, through the middle of the thread's depth.
        const double radius = static_cast<double>(part.a.w) - 0.35 * pitch;
        const Double3 top = v.geometry.to_index({part.center.x + radius, part.center.y, -31.5});
        const int x = static_cast<int>(std::lround(top[0])), y = static_cast<int>(std::lround(top[1])), z = static_cast<int>(top[2]);
        double least = HUGE_VAL, greatest = -HUGE_VAL;
        for (int k = 0; k < 8; ++k) {
            const double here = at(v, x, y, z - k), turn = at(v, x, y, z - k - 8);
            EXPECT_NEAR(here, turn, 180) << k; // noise has a deviation of 18
            least = std::min(least, here), greatest = std::max(greatest, here);
        }
        EXPECT_GT(greatest - least, 2000);
        // A quarter of a turn around is a quarter of a pitch along: right-handed.
        const Double3 left = v.geometry.to_index({part.center.x, part.center.y + radius, -31.5});
        const int left_x = static_cast<int>(std::lround(left[0])), left_y = static_cast<int>(std::lround(left[1]));
        double differs = 0, differs_left_handed = 0;
        for (int k = 0; k < 8; ++k) {
            differs += std::abs(at(v, x, y, z - k) - at(v, left_x, left_y, z - k + 2));
            differs_left_handed += std::abs(at(v, x, y, z - k) - at(v, left_x, left_y, z - k - 2));
        }
        EXPECT_LT(differs, 0.4 * differs_left_handed);
    }
    EXPECT_EQ(screws, 2);
}

} // namespace
} // namespace clvr
