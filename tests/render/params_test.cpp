// From a scene to what the kernels read; hashes of frames; environment tables.
#include "host/appearance/environment.hpp"
#include "host/frame/frame.hpp"
#include "host/render/params.hpp"

#include <gtest/gtest.h>

#include <set>

namespace clvr {
namespace {

Voxels oblique_volume() {
    Voxels v;
    v.dims = {20, 30, 40};
    v.bytes.assign(v.count(), 7);
    v.geometry.origin = {5, -3, 11};
    v.geometry.spacing = {0.5, 1.5, 2};
    v.geometry.direction.row = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    return v;
}

TransferTable table() {
    TransferTable t;
    t.first = 10, t.last = 50;
    t.opacity.assign(transfer_entries, 1);
    t.color.assign(4 * transfer_entries, 1);
    t.visible_width = 40;
    return t;
}

shared::VolumeParams volume_of(const Scene& s, const Voxels& v) { return volume_params(s, v, majorant_grid(v), table(), BrickLayout{}); }

Double3 rows_times(const shared::float4* rows, const Double3& d) {
    Double3 r;
    for (int k = 0; k < 3; ++k) r[k] = rows[k].x * d[0] + rows[k].y * d[1] + rows[k].z * d[2];
    return r;
}

TEST(VolumeParams, TakeDirectionsAndGradientsBetweenTheSpaces) {
    const Voxels v = oblique_volume();
    const shared::VolumeParams p = volume_of({}, v);
    const Double3 step = v.geometry.to_world({3, 5, 8}) - v.geometry.to_world({1, 1, 1});
    EXPECT_NEAR(norm(rows_times(p.to_index, step) - Double3{2, 4, 7}), 0, 1e-5);
    // A gradient's product with a step is the difference of the values, in either space.
    const Double3 gradient{0.3, -0.2, 0.9};
    EXPECT_NEAR(inner(rows_times(p.to_normal, gradient), step), inner(gradient, {2, 4, 7}), 1e-5);
    EXPECT_EQ(p.last.x, 19);
    EXPECT_EQ(p.box_low.x, -0.5f);
    EXPECT_EQ(p.box_high.z, 39.5f);
    EXPECT_EQ(p.box_low.w, 10);
    EXPECT_FLOAT_EQ(p.box_high.w, 4095 / 40.0f);
    EXPECT_FLOAT_EQ(p.surface_scale, 4 * 0.5f / 40);
}

TEST(VolumeParams, ClipByBoxAndPlane) {
    const Voxels v = oblique_volume();
    Scene s;
    s.clip_box = {0.25, 0, 0.5, 1, 0.5, 1};
    s.clip_plane = ClipPlane{{2, 1, -1}, 4}; // not of unit length
    const shared::VolumeParams p = volume_of(s, v);
    EXPECT_EQ(p.box_low.x, 4.5f);
    EXPECT_EQ(p.box_low.z, 19.5f);
    EXPECT_EQ(p.box_high.y, 14.5f);
    for (const Double3& at : {Double3{0, 0, 0}, Double3{19, 3, 8}, Double3{4, 29, 30}}) {
        const double in_index = p.plane.x * at[0] + p.plane.y * at[1] + p.plane.z * at[2] - p.plane.w;
        const double in_world = inner(s.clip_plane->normal, v.geometry.to_world(at)) - s.clip_plane->offset;
        EXPECT_NEAR(in_index * norm(s.clip_plane->normal), in_world, 1e-4);
    }
}

TEST(VolumeParams, ExtinctionIs512PerDiagonalUnlessGiven) {
    const Voxels v = oblique_volume();
    Scene s;
    EXPECT_NEAR(resolved_extinction(s, v), 512 / norm({10, 45, 80}), 1e-12);
    s.extinction = 0.25;
    EXPECT_EQ(resolved_extinction(s, v), 0.25);
}

TEST(VolumeParams, AnAxisOfOneVoxelCountsAsTwo) {
    Voxels v;
    v.dims = {1, 5, 1};
    v.bytes.assign(5, 0);
    const shared::VolumeParams p = volume_of({}, v);
    EXPECT_EQ(p.last.x, 1);
    EXPECT_EQ(p.last.y, 4);
    EXPECT_EQ(p.box_high.x, 0.5f);
}

View view_from(const Double3& eye, bool orthographic = false) { return {orthographic, eye, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}; }

TEST(RenderParams, EverySeedAndViewHasItsOwnKey) {
    const Voxels v = oblique_volume();
    std::set<std::pair<std::uint32_t, std::uint32_t>> keys;
    for (std::uint64_t seed : {0ull, 1ull, 2ull, 1ull << 32, ~0ull})
        for (int view : {0, 1, 2, 359}) {
            Scene s;
            s.seed = seed, s.view = view;
            const shared::RenderParams p = render_params(s, v, view_from({0, 0, 0}), {});
            keys.insert({p.key0, p.key1});
        }
    EXPECT_EQ(keys.size(), 20u);
}

TEST(RenderParams, DepthSpansTheBoundingSphere) {
    const Voxels v = oblique_volume();
    const Double3 centre = v.geometry.to_world({9.5, 14.5, 19.5});
    const double radius = norm({10, 45, 80}) / 2;
    for (bool orthographic : {false, true}) {
        const shared::RenderParams p = render_params({}, v, view_from(centre + Double3{0, -300, 0}, orthographic), {});
        EXPECT_NEAR(p.depth_near, 300 - radius, 1e-4);
        EXPECT_NEAR(1 / p.depth_scale, 2 * radius, 1e-4);
    }
    const shared::RenderParams inside = render_params({}, v, view_from(centre), {});
    EXPECT_EQ(inside.depth_near, 0);
    EXPECT_NEAR(1 / inside.depth_scale, radius, 1e-4);
}

TEST(RenderParams, LightSamplesAreSharedOut) {
    const Voxels v = oblique_volume();
    Scene s;
    s.light.headlight = 1;
    const shared::RenderParams all = render_params(s, v, view_from({0, -300, 0}), {});
    EXPECT_GT(all.key_up.w, 0);
    EXPECT_GT(all.key_radiance.w, 0);
    EXPECT_LT(all.key_up.w + all.key_radiance.w, 1);
    s.light.headlight = 0;
    s.light.key = 0;
    const shared::RenderParams sky = render_params(s, v, view_from({0, -300, 0}), {});
    EXPECT_EQ(sky.key_up.w, 0);
    EXPECT_EQ(sky.key_radiance.w, 0);
}

TEST(EnvironmentTables, DistributionsEndAtOneAndDensitiesIntegrateToOne) {
    const int width = 9, height = 5;
    std::vector<float> rgb(3 * width * height);
    for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<float>(i * 7 % 23);
    const EnvironmentTables e = environment_tables(width, height, rgb, 2.5);
    EXPECT_EQ(e.row_cdf.front(), 0);
    EXPECT_EQ(e.row_cdf.back(), 1);
    double chance = 0, luminance = 0;
    for (int r = 0; r < height; ++r) {
        EXPECT_LE(e.row_cdf[r], e.row_cdf[r + 1]);
        EXPECT_NEAR(e.row_cos[r], std::cos(3.14159265358979 * r / height), 1e-7);
        EXPECT_EQ(e.column_cdf[r * (width + 1) + width], 1);
        for (int c = 0; c < width; ++c) {
            const auto& t = e.texel[r * width + c];
            const double solid_angle = (e.row_cos[r] - e.row_cos[r + 1]) * 2 * 3.14159265358979 / width;
            EXPECT_EQ(t.x, 2.5f * rgb[3 * (r * width + c)]);
            chance += t.w * solid_angle;
            luminance += (0.2126 * t.x + 0.7152 * t.y + 0.0722 * t.z) * solid_angle / (4 * 3.14159265358979);
        }
    }
    EXPECT_NEAR(chance, 1, 1e-6);
    EXPECT_NEAR(e.mean_luminance, luminance, 1e-5 * luminance);
}

TEST(EnvironmentTables, CosineNeedsNoLibm) {
    for (int k = 0; k <= 1000; ++k) EXPECT_NEAR(cos_half_turns(k / 1000.0), std::cos(3.14159265358979323846 * k / 1000), 1e-15);
    EXPECT_EQ(cos_half_turns(0), 1);
    EXPECT_EQ(cos_half_turns(1), -1);
}

TEST(PixelHash, KnowsEveryBitNameAndSizeButNoAttribute) {
    Frame f;
    f.width = 3, f.height = 2;
    f.channel("R")[4] = 0.5f;
    const std::string hash = pixel_hash(f);
    EXPECT_EQ(hash.size(), 64u);
    f.attributes["clvr.device"] = "another";
    EXPECT_EQ(pixel_hash(f), hash);
    Frame g = f;
    g.channel("R")[0] = -0.0f;
    EXPECT_NE(pixel_hash(g), hash);
    g = f;
    std::swap(g.width, g.height);
    EXPECT_NE(pixel_hash(g), hash);
    g = f;
    g.channels["S"] = g.channels["R"];
    g.channels.erase("R");
    EXPECT_NE(pixel_hash(g), hash);
}

} // namespace
} // namespace clvr
