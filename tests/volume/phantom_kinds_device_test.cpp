// The computed volumes of machine parts, bare bone, smooth media, rock and fibres.
#include "host/phantom/parts.hpp"
#include "tests/volume/computed_volume.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

using namespace testing;

constexpr const char* kinds[] = {"machine", "skull", "cloud", "rock", "fibres"};

TEST(PhantomKinds, HaveTheSameBitsAtEveryPacketWidthAndGroup) {
    const std::pair<const char*, const char*> hashes[] = {{"machine", "34bf5f5ecf0ec211021274cb8dbf75719c70d0ea568fa1a96940312382c19c35"},
                                                          {"skull", "82d5a3971c8ae0875fedba283a25cb7735176ce897a2ebb578d51f67dc0e4d71"},
                                                          {"cloud", "91ac97c30ff45c77cfa867be391f20cba1b395ef47f3c2ca76f9200c7cf7dc83"},
                                                          {"rock", "6172d3a83488454b3893d8a43915788ce769ad852c1c0b754291e60d7b2c93f1"},
                                                          {"fibres", "a6d5c052150568a9a4757f96b81334cf12b3a08e1937bb0f506da2ea5be636fa"}};
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
    for (const char* name : kinds) {
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
    for (const char* name : kinds) {
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

TEST(Cloud, IsSmoothOverTheWholeRange) {
    Device device = open_device();
    for (const std::uint64_t seed : {0, 1, 2, 3}) {
        const Voxels v = make_phantom(device, "cloud", {Int3{128, 128, 160}, VoxelType::i16, seed});
        const auto* values = v.data<std::int16_t>();
        std::array<std::size_t, 8> eighths{};
        int steepest = 0, most_on_face = -1024;
        std::size_t steep = 0;
        for (int z = 0; z < 160; ++z)
            for (int y = 0; y < 128; ++y)
                for (int x = 0; x < 128; ++x) {
                    const std::size_t i = (static_cast<std::size_t>(z) * 128 + y) * 128 + x;
                    ++eighths[static_cast<std::size_t>((values[i] + 1024) / 512)];
                    const int step = x > 0 ? std::abs(values[i] - values[i - 1]) : 0;
                    steepest = std::max(steepest, step), steep += step > 400;
                    const bool face = x == 0 || x == 127 || y == 0 || y == 127 || z == 0 || z == 159;
                    most_on_face = std::max(most_on_face, face ? int{values[i]} : -1024);
                }
        EXPECT_LT(most_on_face, -900) << seed; // it ends inside of its box
        EXPECT_LT(steepest, 1600) << seed;
        EXPECT_LT(steep, v.count() / 200) << seed;
        for (std::size_t k = 0; k < 8; ++k) EXPECT_GT(eighths[k], v.count() / 1000) << k << " " << seed;
        EXPECT_GT(eighths[0], v.count() / 2) << seed;
    }
}

TEST(Rock, HasConnectedPoresAndThreeMinerals) {
    Device device = open_device();
    for (const std::uint64_t seed : {0, 1}) {
        const Int3 dims{128, 128, 144}; // half a millimetre
        const Voxels v = make_phantom(device, "rock", {dims, VoxelType::i16, seed});
        const auto* values = v.data<std::int16_t>();
        const auto index = [&](int x, int y, int z) { return (static_cast<std::size_t>(z) * dims[1] + y) * dims[0] + x; };
        // Pores and the air around, from a corner on.
        std::vector<std::size_t> ways{0};
        std::vector<bool> reached(v.count());
        reached[0] = true;
        while (!ways.empty()) {
            const std::size_t i = ways.back();
            ways.pop_back();
            const int x = static_cast<int>(i % 128), y = static_cast<int>(i / 128 % 128), z = static_cast<int>(i / 128 / 128);
            const Int3 next[] = {{x - 1, y, z}, {x + 1, y, z}, {x, y - 1, z}, {x, y + 1, z}, {x, y, z - 1}, {x, y, z + 1}};
            for (const Int3& n : next) {
                if (n[0] < 0 || n[1] < 0 || n[2] < 0 || n[0] >= dims[0] || n[1] >= dims[1] || n[2] >= dims[2]) continue;
                const std::size_t to = index(n[0], n[1], n[2]);
                if (!reached[to] && values[to] < -400) reached[to] = true, ways.push_back(to);
            }
        }
        double inside = 0, pores = 0, open = 0, quartz = 0, feldspar = 0, heavy = 0;
        for (int z = 20; z < 124; ++z)
            for (int y = 0; y < 128; ++y)
                for (int x = 0; x < 128; ++x) {
                    if ((x - 63.5) * (x - 63.5) + (y - 63.5) * (y - 63.5) > 50 * 50) continue;
                    const int hu = values[index(x, y, z)];
                    const bool pore = hu < -400;
                    inside += 1, pores += pore, open += pore && reached[index(x, y, z)];
                    quartz += hu > 800 && hu<1150, feldspar += hu> 1350 && hu<1700, heavy += hu> 2200;
                }
        EXPECT_NEAR(pores / inside, 0.25, 0.08) << seed;
        EXPECT_GT(open, 0.97 * pores) << seed;
        EXPECT_NEAR(quartz / inside, 0.3, 0.12) << seed;
        EXPECT_NEAR(feldspar / inside, 0.15, 0.08) << seed;
        EXPECT_NEAR(heavy / inside, 0.05, 0.03) << seed;
    }
}

TEST(Fibres, FollowTheirPathsThinAndThick) {
    Device device = open_device();
    const MadeVolume made = fibres_volume(4);
    const Voxels v = make_phantom(device, "fibres", {Int3{360, 360, 176}, VoxelType::i16, 4}); // quarters of a millimetre
    double thinnest = HUGE_VAL, thickest = 0;
    const auto check = [&](int body, double expected, double within) {
        const auto& parts = made.bodies[static_cast<std::size_t>(body)].parts;
        double sum = 0, n = 0;
        for (std::size_t i = 0; i < parts.size(); i += 7) {
            const double radius = parts[i].a.w;
            thinnest = std::min(thinnest, radius), thickest = std::max(thickest, radius);
            const Double3 at_index = v.geometry.to_index({parts[i].center.x, parts[i].center.y, parts[i].center.z});
            bool in_box = radius > 0.3;
            for (int a = 0; a < 3; ++a) in_box = in_box && at_index[a] > 1 && at_index[a] < v.dims[a] - 2;
            if (in_box) sum += reference::interpolate(v, at_index), n += 1;
        }
        ASSERT_GT(n, 100);
        EXPECT_NEAR(sum / n, expected, within);
    };
    check(shared::CLVR_FIBRES_CARBON, 350, 150); // glass lies over some
    check(shared::CLVR_FIBRES_GLASS, 1700, 150);
    EXPECT_LT(thinnest, 0.25); // the thin ones are near a voxel
    EXPECT_GT(thickest, 0.5);
    EXPECT_NEAR(above(v, 0), 0.05, 0.03);
    EXPECT_LT(above(v, 0), above(v, -850) - 0.5); // the resin is faint
}

} // namespace
} // namespace clvr
