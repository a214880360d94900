// What kernels read from a bricked volume: interpolation, gradient, classification against the reference, the same bits for every brick
// edge, pool count and packet width, no seams.
#include "tests/reference/volume.hpp"
#include "tests/render/scenes.hpp"
#include "tests/render/statistics.hpp"
#include "tests/volume/random_volume.hpp"

#include <algorithm>

namespace clvr::testing {
namespace {

/// Planes of kernels/selftest/volume_values.cl at index positions, their number a multiple of 16.
using Planes = std::vector<float>;

Planes values_at(Device& device, const DeviceVolume& volume, int width, const std::vector<Double3>& positions) {
    Defines defines = volume.defines();
    defines["CLVR_WIDTH"] = std::to_string(width);
    Kernel kernel = device.kernel("selftest/volume_values", defines);
    const std::size_t n = positions.size();
    std::vector<float> in(3 * n);
    for (std::size_t i = 0; i < n; ++i)
        for (int a = 0; a < 3; ++a) in[a * n + i] = static_cast<float>(positions[i][a]);
    const Buffer input = device.upload(in, "positions"), out = device.buffer(4 * 8 * n, "values");
    const auto packets = static_cast<std::uint32_t>(n / width);
    device.launch(kernel, {packets}, {1}, {}, volume.arguments(), input, out, static_cast<std::uint32_t>(n), packets);
    return device.download<float>(out, 8 * n);
}

/// Random positions in the volume's box, voxel centres, faces of bricks and corners of the box among them; exact in float.
std::vector<Double3> probe_positions(const Int3& dims, std::size_t count = 1 << 14) {
    std::mt19937 random(7);
    std::vector<Double3> positions(count);
    for (auto& p : positions)
        for (int a = 0; a < 3; ++a) {
            const double x = -0.5 + dims[a] * static_cast<double>(uniform_float(random));
            const int kind = static_cast<int>(random() % 8);
            p[a] = kind == 0 ? std::round(x) : kind == 1 ? (random() % 2 ? -0.5 : dims[a] - 0.5) : kind == 2 ? std::round(x / 8) * 8 : x;
            p[a] = static_cast<float>(std::clamp(p[a], -0.5, dims[a] - 0.5));
        }
    return positions;
}

/// Random points between low and high, all opacities above 0: every brick is needed.
TransferFunction visible_transfer(double low, double high) {
    Random random(2);
    TransferFunction tf;
    for (int k = 0; k <= 16; ++k)
        tf.points.push_back(
            {low + (high - low) * k / 16, {uniform(random), uniform(random), uniform(random)}, 0.01 + 0.99 * uniform(random)});
    tf.name = "random";
    return tf;
}

Scene scene_for(const Voxels& v) {
    Scene s = plain_scene(8, 1);
    s.camera.eye = Double3{0, -1000, 0};
    s.camera.target = Double3{0, 0, 0};
    s.transfer = visible_transfer(v.type == VoxelType::f32  ? -1.2
                                  : v.type == VoxelType::i8 ? -128
                                                            : 0,
                                  v.type == VoxelType::f32 ? 1.2 : 250);
    return s;
}

void make_oblique(Voxels& v) {
    v.geometry.origin = {12, -30, 7};
    v.geometry.spacing = {0.7, 1.3, 2.1};
    v.geometry.direction.row = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
}

struct VolumeTypes : ::testing::TestWithParam<VoxelType> {};

TEST_P(VolumeTypes, AgreeWithTheReference) {
    Random random(4);
    const VoxelType type = GetParam();
    const bool bytes = type == VoxelType::u8 || type == VoxelType::i8;
    Voxels v = random_volume(random, type, {37, 34, 41},
                             type == VoxelType::f32  ? 1
                             : type == VoxelType::i8 ? -128
                                                     : 0,
                             type == VoxelType::f32 ? -1
                             : bytes                ? 127
                                                    : 255);
    make_oblique(v);
    Device device = shared_device();
    const Stage stage(v, scene_for(v));
    const DeviceVolume volume = stage.upload(device);
    const auto positions = probe_positions(v.dims);
    const Planes found = values_at(device, volume, 16, positions);
    const std::size_t n = positions.size();
    const double range = type == VoxelType::f32 ? 2 : 256;
    std::array<double, 3> worst{};
    for (std::size_t i = 0; i < n; ++i) {
        const double stored = reference::interpolate(v, positions[i]);
        const reference::Classified c = reference::classify(stage.classified.table, stored);
        const Double3 gradient = reference::gradient_world(v, positions[i]);
        worst[0] = std::max(worst[0], std::abs(found[i] - stored) / range);
        worst[1] = std::max(worst[1], std::abs(found[n + i] - c.opacity));
        for (int k = 0; k < 3; ++k) {
            worst[1] = std::max(worst[1], std::abs(found[(2 + k) * n + i] - c.color[k]));
            worst[2] = std::max(worst[2], std::abs(found[(5 + k) * n + i] - gradient[k]) / range);
        }
    }
    EXPECT_LE(worst[0], 5e-7) << "stored value, of the range";
    EXPECT_LE(worst[1], 2e-5) << "classification";
    EXPECT_LE(worst[2], 2e-6) << "gradient, of the range per mm";
}
INSTANTIATE_TEST_SUITE_P(Types, VolumeTypes, ::testing::ValuesIn(all_types),
                         [](const auto& tested) { return voxel_type_name(tested.param); });

TEST(Volume, ThinOnesAgreeWithTheReference) {
    Device device = shared_device();
    Random random(5);
    for (const Int3& dims : {Int3{1, 1, 1}, Int3{1, 40, 3}, Int3{2, 1, 40}, Int3{40, 2, 1}}) {
        const Voxels v = random_volume(random, VoxelType::u8, dims, 0, 255);
        const Stage stage(v, scene_for(v));
        const auto positions = probe_positions(dims, 4096);
        const Planes found = values_at(device, stage.upload(device), 16, positions);
        double worst = 0;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            worst = std::max(worst, std::abs(found[i] - reference::interpolate(v, positions[i])));
            const Double3 gradient = reference::gradient_world(v, positions[i]);
            for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(found[(5 + k) * positions.size() + i] - gradient[k]));
        }
        EXPECT_LE(worst, 2e-4) << dims[0] << "x" << dims[1] << "x" << dims[2];
    }
}

/// A flat volume is one brick of edge 64; bricks of any edge, in any number of pools, at any packet width, give its bits.
TEST(Volume, BricksPoolsAndWidthsGiveTheBitsOfTheFlatVolume) {
    Device device = shared_device();
    Random random(6);
    const Voxels v = random_volume(random, VoxelType::u8, {61, 50, 57}, 0, 255);
    const Stage stage(v, scene_for(v));
    const auto positions = probe_positions(v.dims);
    const auto layout = [&](int log2_edge, std::size_t most) {
        return brick_layout(v, stage.volume.grid, stage.classified.majorants, log2_edge, most);
    };
    const std::size_t no_limit = std::size_t{1} << 40;
    const BrickLayout flat = layout(6, no_limit);
    ASSERT_EQ(flat.offset.size(), 1u);
    const Planes expected = values_at(device, stage.upload(device, flat), 1, positions);
    const auto expect_same = [&](const BrickLayout& l, int width) {
        const Planes found = values_at(device, stage.upload(device, l), width, positions);
        EXPECT_EQ(std::memcmp(found.data(), expected.data(), 4 * found.size()), 0)
            << "brick edge 2^" << l.log2_edge << ", " << l.pools << " pools, width " << width;
    };
    for (int width : {4, 8, 16}) expect_same(flat, width);
    for (int log2_edge : {3, 4, 5}) expect_same(layout(log2_edge, no_limit), 16);
    for (int pools : {2, 4, 8}) {
        const std::size_t whole = layout(3, no_limit).stored_bytes();
        const BrickLayout split = layout(3, whole / pools + whole / 20);
        ASSERT_EQ(split.pools, pools);
        expect_same(split, 16);
    }
}

TEST(Volume, RampHasNoSeams) {
    Device device = shared_device();
    const Voxels v = volume_of<std::uint8_t>({70, 70, 70}, [](int x, int y, int z) { return x + y + z; });
    const Stage stage(v, scene_for(v));
    std::vector<Double3> line;
    for (int i = 0; i < 4096; ++i) line.push_back({69.0 * i / 4095, 68.9 - 68.0 * i / 4095, 0.3 + 67.0 * i / 4095});
    for (int log2_edge : {3, 4, 5}) {
        const BrickLayout layout = brick_layout(v, stage.volume.grid, stage.classified.majorants, log2_edge, std::size_t{1} << 40);
        const Planes found = values_at(device, stage.upload(device, layout), 16, line);
        for (std::size_t i = 0; i < line.size(); ++i) {
            const Double3& p = line[i];
            ASSERT_NEAR(found[i], p[0] + p[1] + p[2], 4e-5) << "brick edge 2^" << log2_edge << " at " << p[0] << " " << p[1] << " " << p[2];
            const bool inside = p[0] > 1 && p[0] < 68 && p[1] > 1 && p[1] < 68 && p[2] > 1 && p[2] < 68;
            for (int k = 5; inside && k < 8; ++k) ASSERT_NEAR(found[k * line.size() + i], 1, 4e-5);
        }
    }
}

} // namespace
} // namespace clvr::testing
