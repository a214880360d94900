// Lights: radiance and density against closed forms, samples against densities, irradiance, the scale of the default light.
#include "host/render/device_lights.hpp"
#include "tests/render/kernel_under_test.hpp"
#include "tests/render/scenes.hpp"
#include "tests/render/statistics.hpp"

#include <algorithm>

namespace clvr::testing {
namespace {

using shared::float4;
enum LightFunction { sample_light, light_at, sample_environment, environment_at };

constexpr int env_width = 16, env_height = 8;

/// Three decades of radiance, a bright texel, black ones.
std::vector<float> test_image() {
    std::mt19937 random(3);
    std::vector<float> rgb(3 * env_width * env_height);
    for (float& x : rgb) x = static_cast<float>(std::pow(10.0, -2 + 3 * uniform_float(random)));
    for (int k = 0; k < 3; ++k) rgb[3 * (2 * env_width + 5) + k] = 300, rgb[3 * (4 * env_width + 6) + k] = 0;
    for (int k = 0; k < 3 * env_width; ++k) rgb[3 * 6 * env_width + k] = 0; // a black row
    return rgb;
}

EnvironmentTables test_tables() { return environment_tables(env_width, env_height, test_image(), 1); }

Scene light_scene() {
    Scene s = plain_scene(8, 1);
    s.camera.eye = Double3{0, -10, 0};
    s.camera.target = Double3{0, 0, 0};
    return s;
}

Scene image_scene(double rotation = 0) {
    Scene s = light_scene();
    s.light.environment = Light::Environment::image;
    s.light.image = "test";
    s.light.image_rotation = rotation;
    return s;
}

Scene sky_scene(double key, double key_angle = 10, double headlight = 0) {
    Scene s = light_scene();
    s.light.environment = Light::Environment::sky;
    s.light.key = key;
    s.light.key_angle = key_angle;
    s.light.headlight = headlight;
    return s;
}

struct Lit {
    std::vector<float4> at;       ///< direction (or 0), density
    std::vector<float4> radiance; ///< w: 1 for a directional light
};

struct Lights : ::testing::Test {
    Device device = shared_device();
    Kernel kernel = test_kernel(device, "light_values", {{"CLVR_WIDTH", "1"}});

    Lit run(const Stage& stage, LightFunction function, const std::vector<float4>& in) {
        const DeviceLights light(device, stage.render, stage.environment);
        const Buffer input = device.upload(in, "in"), at = device.buffer(16 * in.size(), "at"),
                     radiance = device.buffer(16 * in.size(), "radiance");
        const auto count = static_cast<std::uint32_t>(in.size());
        device.launch(kernel, {count}, {64}, {}, light.arguments(), input, at, radiance, count, static_cast<int>(function));
        return {device.download<float4>(at, in.size()), device.download<float4>(radiance, in.size())};
    }
    Lit samples(const Stage& stage, LightFunction function, std::size_t count = 1 << 18) {
        std::mt19937 random(17);
        std::vector<float4> in(count);
        for (auto& u : in) u = {uniform_float(random), uniform_float(random), uniform_float(random), 0};
        return run(stage, function, in);
    }
};

std::unique_ptr<Stage> stage_of(const Scene& scene) {
    const bool image = scene.light.environment == Light::Environment::image;
    return std::make_unique<Stage>(constant_volume({4, 4, 4}), scene, image ? test_tables() : EnvironmentTables{});
}

float4 direction(double z, double turns) {
    const double r = std::sqrt(1 - z * z);
    return {static_cast<float>(r * std::sin(2 * pi * turns)), static_cast<float>(r * std::cos(2 * pi * turns)), static_cast<float>(z), 0};
}

TEST_F(Lights, SkyIsAGradientAndItsDensityFollows) {
    for (bool constant : {false, true}) {
        Scene scene = sky_scene(0);
        scene.light.level = 2;
        if (constant) scene.light.environment = Light::Environment::constant;
        const auto stage = stage_of(scene);
        const double a = constant ? 2 : stage->render.sky.x, b = constant ? 0 : 0.5 * a; // the sky: 0.3 below to 0.9 above, scaled
        std::vector<float4> in;
        for (int i = 0; i <= 100; ++i) in.push_back(direction(-1 + i / 50.0, i * 0.37));
        const Lit found = run(*stage, environment_at, in);
        for (std::size_t i = 0; i < in.size(); ++i) {
            EXPECT_NEAR(found.radiance[i].x, a + b * in[i].z, 1e-6);
            EXPECT_NEAR(found.at[i].w, (a + b * in[i].z) / (4 * pi * a), 1e-6);
        }
        constexpr std::size_t count = 1 << 18;
        constexpr int bins = 32;
        std::vector<double> polar(bins, 0), around(bins, 0), expected(bins);
        for (const float4& s : samples(*stage, sample_environment, count).at) {
            ASSERT_NEAR(s.x * s.x + s.y * s.y + s.z * s.z, 1, 1e-6);
            ++polar[std::min(bins - 1, static_cast<int>((s.z + 1) / 2 * bins))];
            ++around[std::min(bins - 1, static_cast<int>((std::atan2(s.y, s.x) / (2 * pi) + 0.5) * bins))];
        }
        const auto distribution = [&](double z) { return (a * (z + 1) + b / 2 * (z * z - 1)) / (2 * a); };
        for (int k = 0; k < bins; ++k) expected[k] = count * (distribution(-1 + 2.0 * (k + 1) / bins) - distribution(-1 + 2.0 * k / bins));
        expect_counts(polar, expected, "height");
        expect_counts(around, std::vector<double>(bins, count / double{bins}), "azimuth");
    }
}

TEST_F(Lights, ImageIsReadByTexel) {
    const std::vector<float> rgb = test_image();
    for (double rotation : {0.0, 90.0, -37.0}) {
        const auto stage = stage_of(image_scene(rotation));
        std::vector<float4> in;
        std::vector<int> texel;
        for (int r = 0; r < env_height; ++r)
            for (int c = 0; c < env_width; ++c)
                for (double inside : {0.02, 0.5, 0.98}) {
                    // Row 0 at +z; columns from -y over -x, +y (the image's centre) and +x, turned by the rotation from +x towards +y.
                    const double turns = (c + inside) / env_width - 0.5 - rotation / 360;
                    in.push_back(direction(std::cos(pi * (r + inside) / env_height), turns));
                    texel.push_back(r * env_width + c);
                }
        const Lit found = run(*stage, environment_at, in);
        for (std::size_t i = 0; i < in.size(); ++i) {
            EXPECT_EQ(found.radiance[i].x, rgb[3 * texel[i]]) << "rotation " << rotation << ", texel " << texel[i];
            EXPECT_EQ(found.radiance[i].z, rgb[3 * texel[i] + 2]);
            EXPECT_EQ(found.at[i].w, stage->environment.texel[texel[i]].w);
        }
    }
}

TEST_F(Lights, ImageSamplesHaveTheDensity) {
    const auto stage = stage_of(image_scene());
    constexpr std::size_t count = 1 << 18;
    const Lit found = samples(*stage, sample_environment, count);
    std::vector<double> counts(env_width * env_height, 0), expected(counts.size());
    std::vector<double> brightest_z, brightest_turn;
    for (const float4& s : found.at) {
        const double turns = std::atan2(s.x, s.y) / (2 * pi) + 0.5, height = std::acos(std::clamp(s.z, -1.0f, 1.0f)) / pi;
        const int c = std::min(env_width - 1, static_cast<int>(turns * env_width)),
                  r = std::min(env_height - 1, static_cast<int>(height * env_height));
        ++counts[r * env_width + c];
        if (r == 2 && c == 5) brightest_z.push_back(s.z), brightest_turn.push_back(turns * env_width - 5);
    }
    double all = 0;
    for (int t = 0; t < env_width * env_height; ++t) {
        const int r = t / env_width;
        const double solid = 2 * pi / env_width * (std::cos(pi * r / env_height) - std::cos(pi * (r + 1) / env_height));
        expected[t] = count * stage->environment.texel[t].w * solid;
        all += expected[t];
    }
    EXPECT_NEAR(all / count, 1, 1e-6) << "the density integrates to 1";
    expect_counts(counts, expected, "texels");
    // Within a texel samples are uniform over its solid angle.
    const Estimate z = estimate(brightest_z), turn = estimate(brightest_turn);
    EXPECT_NEAR(z.mean, (std::cos(pi * 2 / 8) + std::cos(pi * 3 / 8)) / 2, 4 * z.sigma);
    EXPECT_NEAR(turn.mean, 0.5, 4 * turn.sigma);
}

struct Named {
    const char* name;
    Scene scene;
};

double image_flux() {
    const std::vector<float> rgb = test_image();
    double sum = 0;
    for (int t = 0; t < env_width * env_height; ++t) {
        const int r = t / env_width;
        sum += rgb[3 * t] * 2 * pi / env_width * (std::cos(pi * r / env_height) - std::cos(pi * (r + 1) / env_height));
    }
    return sum;
}

/// Integral of the radiance over the sphere, and irradiance of the directional lights (red).
double flux(const Stage& stage) {
    const shared::RenderParams& r = stage.render;
    const double key = r.key_radiance.x * (r.key.w < 1 ? 2 * pi * (1 - std::cos(stage.scene.light.key_angle / 2 * pi / 180)) : 1);
    const bool image = stage.scene.light.environment == Light::Environment::image;
    return (image ? image_flux() : 4 * pi * r.sky.x) + key + stage.scene.light.headlight;
}

std::vector<Named> every_light() {
    Scene image = image_scene(123), dark = sky_scene(1.5);
    image.light.key = 1;
    image.light.headlight = 2;
    dark.light.environment = Light::Environment::constant;
    dark.light.level = 0;
    return {{"sky", sky_scene(0)},
            {"soft key", sky_scene(1.5)},
            {"wide key", sky_scene(2, 170)},
            {"directional key and headlight", sky_scene(1, 0, 0.5)},
            {"image", image_scene(123)},
            {"image, soft key and headlight", image},
            {"key alone", dark}};
}

TEST_F(Lights, SamplesAgreeWithTheRadianceAndDensityOfTheirDirection) {
    for (const Named& light : every_light()) {
        const auto stage = stage_of(light.scene);
        const Lit sampled = samples(*stage, sample_light);
        const Lit met = run(*stage, light_at, sampled.at);
        std::vector<double> estimates;
        int outside = 0;
        for (std::size_t i = 0; i < sampled.at.size(); ++i) {
            const float4 &radiance = sampled.radiance[i], &at = sampled.at[i];
            ASSERT_NEAR(at.x * at.x + at.y * at.y + at.z * at.z, 1, 1e-6) << light.name;
            if (radiance.w > 0) { // directional: irradiance over the chance of its choice
                ASSERT_EQ(at.w, 0) << light.name;
                estimates.push_back(radiance.x);
                continue;
            }
            ASSERT_EQ(radiance.x, met.radiance[i].x) << light.name;
            ASSERT_EQ(at.w, met.at[i].w) << light.name;
            if (at.w <= 0) { // rounding may put a sample of the disc's border outside it
                const shared::float4& key = stage->render.key;
                const double cosine = double{at.x} * key.x + double{at.y} * key.y + double{at.z} * key.z;
                ASSERT_NEAR(cosine, key.w, 2e-7) << light.name;
                ++outside;
            }
            estimates.push_back(at.w > 0 ? radiance.x / at.w : 0);
        }
        EXPECT_LE(outside, 4) << light.name;
        const Estimate e = estimate(estimates);
        EXPECT_LE(e.sigma, 0.004 * e.mean) << light.name;
        EXPECT_NEAR(e.mean, flux(*stage), 4 * e.sigma + 1e-5 * e.mean) << light.name;
    }
}

TEST_F(Lights, KeyIsAUniformDisc) {
    const auto stage = stage_of(sky_scene(1, 40));
    const Double3 key{stage->render.key.x, stage->render.key.y, stage->render.key.z};
    const double e = stage->scene.light.key_elevation * pi / 180,
                 a = stage->scene.light.key_azimuth * pi / 180; // the camera's azimuth is 0
    EXPECT_NEAR(norm(key - Double3{std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e)}), 0, 1e-6);
    const double chance = stage->render.key_up.w, border = std::cos(20 * pi / 180);
    std::mt19937 random(23);
    std::vector<float4> in(1 << 16);
    for (auto& u : in) u = {static_cast<float>(chance * uniform_float(random)), uniform_float(random), uniform_float(random), 0};
    std::vector<double> share, side;
    for (const float4& s : run(*stage, sample_light, in).at) {
        const Double3 d{s.x, s.y, s.z};
        ASSERT_GE(inner(d, key), border - 1e-6);
        share.push_back((inner(d, key) - border) / (1 - border));
        side.push_back(inner(d, unit(cross(key, {0, 0, 1}))));
    }
    const Estimate m = estimate(share), s = estimate(side);
    EXPECT_NEAR(m.mean, 0.5, 4 * m.sigma); // uniform over the solid angle
    EXPECT_NEAR(s.mean, 0, 4 * s.sigma);
    std::vector<float4> around;
    for (double angle : {0.0, 19.9, 20.1, 60.0}) {
        const Double3 d = key * std::cos(angle * pi / 180) + unit(cross(key, {0, 0, 1})) * std::sin(angle * pi / 180);
        around.push_back({static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2]), 0});
    }
    const Lit met = run(*stage, light_at, around);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(met.radiance[i].x > 1.0f, i < 2) << i;
}

/// A white Lambert surface that faces the key under the default light has radiance 1; no other one has more (host/README.md, "Lights").
TEST_F(Lights, DefaultLightIsScaledToOne) {
    const auto stage = stage_of(sky_scene(1));
    const Lit sampled = samples(*stage, sample_light, 1 << 20);
    const Double3 key{stage->render.key.x, stage->render.key.y, stage->render.key.z};
    double brightest = 0;
    for (int i = 0; i < 200; ++i) {
        const double z = -1 + (i + 0.5) / 100, turn = i * 0.61803398875;
        const float4 d = direction(z, turn);
        const Double3 normal = i == 0 ? key : Double3{d.x, d.y, d.z};
        std::vector<double> values;
        for (std::size_t k = 0; k < sampled.at.size(); k += i == 0 ? 1 : 16) {
            const float4& s = sampled.at[k];
            values.push_back(std::max(0.0, inner(normal, {s.x, s.y, s.z})) * sampled.radiance[k].x / s.w / pi);
        }
        const Estimate e = estimate(values);
        if (i == 0) {
            EXPECT_NEAR(e.mean, 1, 4 * e.sigma + 1e-6);
        }
        brightest = std::max(brightest, e.mean - 4 * e.sigma);
    }
    EXPECT_LE(brightest, 1.0);
}

TEST(EnvironmentTables, BlackImageHasAUniformDensity) {
    const EnvironmentTables e = environment_tables(8, 4, std::vector<float>(96, 0.0f), 1);
    EXPECT_EQ(e.mean_luminance, 0);
    for (const auto& t : e.texel) {
        EXPECT_EQ(t.x, 0);
        EXPECT_NEAR(t.w, 1 / (4 * pi), 1e-7);
    }
}

} // namespace
} // namespace clvr::testing
