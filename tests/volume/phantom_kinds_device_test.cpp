// The computed volumes that are no creatures: machine.
#include "host/volume/phantom_parts.hpp"
#include "tests/volume/computed_volume.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

using namespace testing;

/// Hounsfield units of a voxel.
double at(const Voxels& v, int x, int y, int z) { return v.slope * reference::stored_at(v, {x, y, z}) + v.intercept; }

TEST(PhantomKinds, HaveTheSameBitsAtEveryPacketWidthAndGroup) {
    const std::pair<const char*, const char*> hashes[] = {{"machine", "34bf5f5ecf0ec211021274cb8dbf75719c70d0ea568fa1a96940312382c19c35"}};
    Device device = open_device();
    for (const auto& [name, hash] : hashes)
        for (const auto& [packet, group] : {std::pair{16, 1}, {4, 2}, {1, 8}}) {
            device.set_tunable("packet", packet);
            device.set_tunable("phantom_group", group);
            // A change of the volume changes its hash, on purpose only.
            EXPECT_EQ(hash_of(make_phantom(device, name, {Int3{61, 45, 37}})), hash) << name << " in packets of " << packet;
        }
}

TEST(PhantomKinds, FollowTheirSeeds) {
    Device device = open_device();
    for (const char* name : {"machine"}) {
        const Voxels first = make_phantom(device, name, {Int3{48, 48, 48}, VoxelType::i16, 1}),
                     other = make_phantom(device, name, {Int3{48, 48, 48}, VoxelType::i16, 2});
        EXPECT_EQ(hash_of(first), hash_of(make_phantom(device, name, {Int3{48, 48, 48}, VoxelType::i16, 1}))) << name;
        std::size_t moved = 0; // by more than noise
        for (std::size_t i = 0; i < first.count(); ++i)
            moved += std::abs(first.data<std::int16_t>()[i] - other.data<std::int16_t>()[i]) > 200;
        EXPECT_GT(moved, first.count() / 100) << name;
    }
}

TEST(PhantomKinds, KeepTheirValuesInEveryType) {
    Device device = open_device();
    for (const char* name : {"machine"}) {
        const Voxels hu = make_phantom(device, name, {Int3{21, 30, 33}, VoxelType::i16});
        for (const VoxelType type : {VoxelType::u8, VoxelType::u16, VoxelType::f32}) {
            const Voxels v = make_phantom(device, name, {hu.dims, type});
            for (int z = 0; z < v.dims[2]; ++z) {
                const double lost = at(hu, 11, 15, z) - at(v, 11, 15, z);
                ASSERT_GE(lost, 0) << name << " " << voxel_type_name(type);
                ASSERT_LT(lost, v.slope) << name << " " << voxel_type_name(type);
            }
        }
    }
}

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
