#include "host/phantom/phantom.hpp"
#include "runtime/error.hpp"
#include "tests/volume/computed_volume.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

using namespace testing;

constexpr Int3 odd_dims{45, 37, 53}, half_dims{88, 110, 116};

TEST(Phantom, HasTheSameBitsAtEveryPacketWidthAndGroup) {
    Device device = open_device();
    for (const auto& [packet, group] : {std::pair{16, 1}, {16, 2}, {8, 4}, {4, 1}, {1, 1}, {1, 8}, {16, 1}}) {
        device.set_tunable("packet", packet);
        device.set_tunable("phantom_group", group);
        // A change of the head changes this hash, on purpose only.
        EXPECT_EQ(hash_of(make_phantom(device, "head", {odd_dims})), "f6d6b98202598b10d0c3feddcaff233ff62995d9efa799a5635959488a604317")
            << "packets of " << packet << " in groups of " << group;
    }
}

TEST(Phantom, OthersHaveTheSameBitsAtEveryPacketWidth) {
    const std::pair<const char*, const char*> hashes[] = {{"beetle", "f357872bf9b74e1bd908695903e3743cad9acf7e6d2c6ad56650e44ace9c6ce0"},
                                                          {"snake", "6fea4253de4184a90728dac00433c485ff23647ed38c6399c099c52934b343db"},
                                                          {"vessels", "76234e9d50dbbadd4c29b2b4c5c8627c2c071e400380c969f6880266b75782af"},
                                                          {"foam", "47504f2323a2dd1cf1b0096dca31574574dd64325f5a5b3e9ee50a0e3ff1bf07"}};
    Device device = open_device();
    for (const auto& [name, hash] : hashes)
        for (const int packet : {16, 4, 1}) {
            device.set_tunable("packet", packet);
            const Voxels v = make_phantom(device, name, {Int3{61, 45, 37}});
            EXPECT_EQ(hash_of(v), hash) << name << " in packets of " << packet;
        }
}

TEST(Phantom, OthersHaveTheirPartsWhereTheyBelong) {
    Device device = open_device();
    const Voxels beetle = make_phantom(device, "beetle", {Int3{208, 208, 124}});
    EXPECT_EQ(beetle.type, VoxelType::u16);
    EXPECT_GT(greatest(beetle, {0.6, 15, 5}, {0.6, 15, 12}), 0);  // wing case above,
    EXPECT_LT(greatest(beetle, {3, 15, 0}, {3, 15, 4}), -300);    // little under it
    EXPECT_GT(greatest(beetle, {33, 9, -13}, {31, 5, -6}), -300); // a shin, on both sides
    EXPECT_GT(greatest(beetle, {-33, 9, -13}, {-31, 5, -6}), -300);
    EXPECT_NEAR(hounsfield(beetle, {0, 35, 20}), -1000, 15);
    EXPECT_NEAR(above(beetle, -200), 0.015, 0.012);
    const Voxels snake = make_phantom(device, "snake", {Int3{256, 256, 200}});
    EXPECT_EQ(snake.type, VoxelType::u8);
    EXPECT_GT(greatest(snake, {0, 0, -19}, {0, 0, -16}), 100); // shell below, none above
    EXPECT_LT(greatest(snake, {0, 0, 15}, {0, 0, 19}), -900);
    EXPECT_NEAR(above(snake, 500), 0.002, 0.0015); // spine, ribs, skull
    const Voxels vessels = make_phantom(device, "vessels", {Int3{96, 76, 96}});
    EXPECT_NEAR(hounsfield(vessels, {6, 0, -42}), 380, 40); // the first stem
    EXPECT_NEAR(above(vessels, 200), 0.02, 0.015);
    EXPECT_NEAR(above(make_phantom(device, "foam", {Int3{64, 64, 64}}), -500), 0.15, 0.12);
    EXPECT_NE(hash_of(make_phantom(device, "vessels", {Int3{48, 38, 48}, {}, 1})),
              hash_of(make_phantom(device, "vessels", {Int3{48, 38, 48}, {}, 2})));
}

TEST(Phantom, HasItsTissuesWhereTheyBelong) {
    Device device = open_device();
    const Voxels v = make_phantom(device, "head-closed", {half_dims});
    EXPECT_EQ(v.modality, "CT");
    EXPECT_EQ(v.slope, 1);
    EXPECT_EQ(v.intercept, 0);
    EXPECT_NEAR(v.geometry.spacing[0], 2.2, 1e-9);
    EXPECT_NEAR(hounsfield(v, {-80, -110, 110}), -1000, 10); // air around
    EXPECT_NEAR(hounsfield(v, {26, -59, -10}), -1000, 40);   // maxillary sinus
    EXPECT_NEAR(hounsfield(v, {0, -20, -10}), -1000, 40);    // throat
    EXPECT_NEAR(hounsfield(v, {22, 8, 66}), 32, 14);         // brain
    EXPECT_NEAR(hounsfield(v, {13, 16, 58}), 6, 14);         // lateral ventricle
    EXPECT_NEAR(hounsfield(v, {-32, -72, 15}), 14, 16);      // eyeball
    EXPECT_NEAR(hounsfield(v, {-30, 55, -90}), 40, 40);      // muscles of the neck
    EXPECT_GT(hounsfield(v, {0, -107, -12}), -100);          // the nose points to -y
    EXPECT_NEAR(hounsfield(v, {0, 112, -12}), -1000, 10);
    EXPECT_NEAR(greatest(v, {34, 8, -80}, {34, 8, -75}), 350, 40); // jugular vein
    EXPECT_GT(greatest(v, {-20, 10, 115}, {-20, 10, 132}), 900);   // skull
    EXPECT_GT(greatest(v, {4, -98, -38}, {4, -84, -38}), 1500);    // tooth
    EXPECT_LT(greatest(v, {-20, 10, 70}, {-20, 10, 100}), 420);    // no bone in the brain
}

TEST(Phantom, OpensOnThePatientsLeftOnly) {
    Device device = open_device();
    const Voxels opened = make_phantom(device, "head", {half_dims}), closed = make_phantom(device, "head-closed", {half_dims});
    std::size_t same_right = 0, right = 0, changed_left = 0;
    for (std::size_t i = 0; i < opened.count(); ++i) {
        const bool same = opened.data<std::int16_t>()[i] == closed.data<std::int16_t>()[i];
        const double x = opened.geometry.to_world({static_cast<double>(i % half_dims[0]), 0, 0})[0];
        if (x < -5) ++right, same_right += same;
        if (x > 5) changed_left += !same;
    }
    EXPECT_EQ(same_right, right);
    EXPECT_GT(changed_left, opened.count() / 50);
    EXPECT_GT(greatest(closed, {40, 10, 98}, {40, 10, 122}), 900);  // skull above the brain ...
    EXPECT_LT(greatest(opened, {40, 10, 98}, {40, 10, 122}), 420);  // ... and a window there
    EXPECT_GT(greatest(opened, {50, -84, 34}, {30, -70, 34}), 700); // the brow's bone stays
}

TEST(Phantom, KeepsItsValuesInEveryType) {
    Device device = open_device();
    const Voxels hu = make_phantom(device, "head", {odd_dims});
    for (const VoxelType type : {VoxelType::u8, VoxelType::i8, VoxelType::u16, VoxelType::f32}) {
        const Voxels v = make_phantom(device, "head", {odd_dims, type});
        ASSERT_EQ(v.bytes.size(), v.count() * voxel_bytes(type));
        for (int z = 0; z < odd_dims[2]; ++z)
            for (int y = 0; y < odd_dims[1]; ++y)
                for (int x = 0; x < odd_dims[0]; ++x) {
                    const double lost = reference::stored_at(hu, {x, y, z}) - (v.slope * reference::stored_at(v, {x, y, z}) + v.intercept);
                    ASSERT_GE(lost, 0) << voxel_type_name(type);
                    ASSERT_LT(lost, v.slope) << voxel_type_name(type);
                }
    }
}

TEST(Phantom, FollowsItsSeed) {
    Device device = open_device();
    const Voxels first = make_phantom(device, "head", {odd_dims, VoxelType::i16, 1});
    EXPECT_EQ(hash_of(first), hash_of(make_phantom(device, "head", {odd_dims, VoxelType::i16, 1})));
    EXPECT_NE(hash_of(first), hash_of(make_phantom(device, "head", {odd_dims, VoxelType::i16, 2})));
    EXPECT_NE(hash_of(first), hash_of(make_phantom(device, "head", {odd_dims, VoxelType::i16, std::uint64_t{1} << 32 | 1})));
}

TEST(Phantom, TakesAwkwardDims) {
    Device device = open_device();
    for (const Int3& dims : {Int3{1, 1, 1}, Int3{1, 33, 7}, Int3{17, 1, 40}, Int3{300, 2, 9}}) {
        const Voxels v = make_phantom(device, "head", {dims});
        EXPECT_EQ(v.dims, dims);
        EXPECT_EQ(v.bytes.size(), 2 * v.count());
    }
}

TEST(Phantom, RefusesWhatItDoesNotKnow) {
    Device device = open_device();
    const auto refused = [&](const std::string& name, const Int3& dims, const std::string& expected) {
        try {
            make_phantom(device, name, {dims});
            ADD_FAILURE() << name;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::usage);
            EXPECT_NE(e.line().find(expected), std::string::npos) << e.line();
        }
    };
    refused("torso", odd_dims, "head, head-closed");
    refused("head", {0, 10, 10}, "0x10x10");
    refused("head", {10, 10, 2049}, "10x10x2049");
}

} // namespace
} // namespace clvr
