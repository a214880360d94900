// Whole frames through the denoiser: the same bits for every shape of the work, what it does with odd input, what
// kernels/denoise/README.md, "Properties" promises.
#include "host/denoise/denoiser.hpp"
#include "runtime/error.hpp"
#include "tests/denoise/batches.hpp"
#include "tests/denoise/frames.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace clvr::testing {
namespace {

Model test_model(bool preprocessing = true) {
    Model m;
    m.channels = reference_channels();
    m.exposure = m.opacity_weight = preprocessing;
    m.albedo_floor = preprocessing ? 1.0f / 32 : 0x1p-20f;
    initialise(m, 5);
    return m;
}

std::string denoised_hash(const std::map<std::string, int>& tunables, const Frame& frame, const Model& model, std::size_t memory = 0) {
    Device device = test_device();
    for (const auto& [name, value] : tunables) device.set_tunable(name, value);
    if (memory > 0) device.set_memory_limit(memory);
    return pixel_hash(Denoiser(device, model).denoise(frame));
}

TEST(Denoiser, GivesTheSameBitsInTiles) {
    const Frame frame = noisy_frame(300, 421);
    const std::string hash = denoised_hash({}, frame, test_model());
    EXPECT_EQ(denoised_hash({{"denoise_mib", 40}}, frame, test_model()), hash); // whole rows
    EXPECT_EQ(denoised_hash({{"denoise_mib", 14}}, frame, test_model()), hash); // parts of rows
    EXPECT_EQ(denoised_hash({}, frame, test_model(), std::size_t{20} << 20), hash);
}

TEST(Denoiser, GivesTheSameBitsInBandsOfRows) {
    for (const auto& [width, height] : {std::pair(70, 131), {300, 9}, {17, 40}}) {
        const Frame frame = noisy_frame(width, height);
        const std::string hash = denoised_hash({}, frame, test_model());
        for (const int pixels : {1, 64, 1024, 8192})
            EXPECT_EQ(denoised_hash({{"band_pixels", pixels}}, frame, test_model()), hash) << pixels;
    }
    const Frame frame = noisy_frame(140, 170);
    EXPECT_EQ(denoised_hash({{"band_pixels", 4096}, {"denoise_mib", 10}}, frame, test_model()), denoised_hash({}, frame, test_model()));
}

TEST(Denoiser, GoesFromSizeToSizeInTheSameMemory) {
    Device device = test_device();
    Denoiser denoiser(device, test_model());
    const Frame large = noisy_frame(160, 120), small = noisy_frame(37, 90);
    const std::string of_large = pixel_hash(denoiser.denoise(large));
    const std::size_t peak = device.peak_bytes();
    const std::string of_small = pixel_hash(denoiser.denoise(small));
    EXPECT_EQ(of_small, denoised_hash({}, small, test_model()));
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(pixel_hash(denoiser.denoise(large)), of_large);
        EXPECT_EQ(pixel_hash(denoiser.denoise(small)), of_small);
    }
    EXPECT_LT(device.peak_bytes(), peak + peak / 10); // weights of both for a moment
}

TEST(Denoiser, TakesLessThan600MebibytesAt1080p) {
    Device device = test_device();
    Denoiser(device, test_model()).denoise(noisy_frame(1920, 1080));
    EXPECT_LT(device.peak_bytes(), std::size_t{600} << 20);
}

TEST(Denoiser, TilesOfOddLevels) {
    Model model = test_model();
    model.levels = {{3, 5}, {6, 64}, {10, 256}};
    initialise(model, 2);
    const Frame frame = noisy_frame(131, 257);
    EXPECT_EQ(denoised_hash({{"denoise_mib", 8}}, frame, model), denoised_hash({}, frame, model));
}

TEST(Denoiser, TakesAnySize) {
    for (const auto& [width, height] : {std::pair(1, 1), {1, 40}, {17, 3}, {64, 64}, {81, 33}}) {
        Device device = test_device();
        const Frame done = Denoiser(device, test_model()).denoise(noisy_frame(width, height));
        EXPECT_EQ(done.at("R").size(), static_cast<std::size_t>(width) * height);
        for (const char* c : {"R", "G", "B"})
            for (const float v : done.at(c)) ASSERT_TRUE(std::isfinite(v) && v >= 0);
        EXPECT_TRUE(done.has("noisy.R"));
        EXPECT_EQ(done.at("A"), done.at("opacity.A"));
    }
}

TEST(Denoiser, LeavesAConstantPictureConstant) {
    Frame frame = noisy_frame(90, 50);
    for (const char* c : {"R", "G", "B"}) std::fill(frame.channel(c).begin(), frame.channel(c).end(), 0.75f);
    for (const char* c : {"albedo.R", "albedo.G", "albedo.B"}) std::fill(frame.channel(c).begin(), frame.channel(c).end(), 0.5f);
    for (const char* c : {"A", "opacity.A"}) std::fill(frame.channel(c).begin(), frame.channel(c).end(), 1.0f);
    Device device = test_device();
    const Frame done = Denoiser(device, test_model()).denoise(frame);
    for (const float v : done.at("G")) ASSERT_NEAR(v, 0.75, 2e-6);
}

TEST(Denoiser, IsLinearInRadianceWhenTheGuidesAreFixed) {
    // The network sees tone-mapped beauty: with channels that are features alone, the guides do not depend on it.
    Model model;
    model.channels = {"albedo.R", "albedo.G", "albedo.B", "depth.Z"};
    initialise(model, 9);
    Frame frame = noisy_frame(70, 45), doubled = frame;
    for (const char* c : {"R", "G", "B"})
        for (float& v : doubled.channel(c)) v *= 2;
    Device device = test_device();
    Denoiser denoiser(device, model);
    const Frame a = denoiser.denoise(frame), b = denoiser.denoise(doubled);
    for (std::size_t i = 0; i < a.pixels(); ++i) ASSERT_EQ(2 * a.at("B")[i], b.at("B")[i]);
}

TEST(Denoiser, WithoutDemodulationTakesTheRadianceAsItIs) {
    // Radiance that is constant times a fine albedo: demodulated, every pixel is the constant times its albedo again; else it is blurred.
    Frame frame = noisy_frame(64, 48);
    for (std::size_t i = 0; i < frame.pixels(); ++i)
        for (const char* c : {"R", "G", "B"}) {
            const float albedo = frame.channel(std::string("albedo.") + c)[i] = (i % 64 / 2 % 2) ? 0.25f : 0.75f;
            frame.channel(c)[i] = 0.5f * albedo;
        }
    for (const char* c : {"A", "opacity.A"}) frame.channel(c).assign(frame.pixels(), 1.0f);
    Device device = test_device();
    Model model = test_model();
    const auto furthest = [&] {
        const Frame done = Denoiser(device, model).denoise(frame);
        float most = 0;
        for (std::size_t i = 0; i < frame.pixels(); ++i) most = std::max(most, std::abs(done.at("G")[i] - frame.at("G")[i]));
        return most;
    };
    EXPECT_LT(furthest(), 1e-6f);
    model.demodulation = false;
    EXPECT_GT(furthest(), 0.01f);
}

TEST(Denoiser, RepairsWhatIsNotFinite) {
    Frame frame = noisy_frame(60, 60);
    frame.channel("R")[30 * 60 + 30] = std::numeric_limits<float>::quiet_NaN();
    frame.channel("depth.Z")[31 * 60 + 30] = std::numeric_limits<float>::infinity();
    Device device = test_device();
    Denoiser denoiser(device, test_model());
    const Frame done = denoiser.denoise(frame);
    EXPECT_EQ(denoiser.repaired(), 2u);
    for (const float v : done.at("R")) ASSERT_TRUE(std::isfinite(v));
}

struct Band {
    double change = 0, variance = 0;
};

/// The two bands of blend_bands.cl at a pixel.
std::array<Band, 2> bands_at(const std::vector<float>& noisy, const std::vector<float>& denoised, const std::vector<float>& variance,
                             double noise, int width, int x, int y) {
    const int height = static_cast<int>(noisy.size()) / width;
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(y + j) * width + x + i; };
    const auto changed = [&](std::size_t i) { return static_cast<double>(noisy[i]) - denoised[i]; };
    double whole = 0;
    std::map<std::size_t, double> weights; // of the pixels in the low band
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
            if (x + i >= 0 && x + i < width && y + j >= 0 && y + j < height) {
                weights[at(i, j)] = (2 - std::abs(i)) * (2 - std::abs(j)) / 16.0;
                whole += weights[at(i, j)] * denoised[at(i, j)];
            }
    Band low, rest;
    for (const auto& [i, k] : weights) {
        const double weight = whole > 0 ? k * denoised[at(0, 0)] / whole : 0, other = (i == at(0, 0)) - weight, v = noise * variance[i];
        low.change += weight * changed(i), low.variance += weight * weight * v;
        rest.change += other * changed(i), rest.variance += other * other * v;
    }
    return {low, rest};
}

/// Against the formula in double precision, across a seam of bands of rows.
TEST(Denoiser, GoesBackToTheInputWhereThatHasConverged) {
    const int width = 43, height = 290; // more than a band of rows
    const Frame plain = noisy_frame(width, height);
    Device device = test_device();
    Denoiser denoiser(device, test_model());
    const Frame out = denoiser.denoise(plain);
    const std::vector<float>&noisy = plain.at("G"), &denoised = out.at("G");
    std::size_t between = 0;
    for (const auto& [level, spp, noise] : {std::tuple{0.0f, "", 1.0}, {0.02f, "4", 1.4}, {0.1f, "64", 0.65}, {1e6f, "8", 1.0}}) {
        Frame frame = plain;
        frame.attributes.erase("clvr.spp");
        if (*spp) frame.attributes["clvr.spp"] = spp;
        for (const char* c : {"R", "G", "B"}) {
            std::vector<float>& v = frame.channel(std::string("variance.") + c);
            for (std::size_t i = 0; i < v.size(); ++i) v[i] = level * static_cast<float>(i % 5) * noisy[i];
        }
        const std::vector<float> done = denoiser.denoise(frame).at("G"), &variance = frame.at("variance.G");
        std::vector<std::array<Band, 2>> bands(frame.pixels());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                bands[static_cast<std::size_t>(y) * width + x] = bands_at(noisy, denoised, variance, noise, width, x, y);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const std::size_t at = static_cast<std::size_t>(y) * width + x;
                double expected = denoised[at], least = 1;
                for (std::size_t b = 0; b < 2; ++b) {
                    double excess = 0, squares = 0, variances = 0;
                    for (int j = std::max(0, y - 10); j <= std::min(height - 1, y + 10); ++j)
                        for (int i = std::max(0, x - 10); i <= std::min(width - 1, x + 10); ++i) {
                            const std::size_t near = static_cast<std::size_t>(j) * width + i;
                            const double w = 1 / (denoised[near] + 0.01), v = bands[near][b].variance;
                            const double e = w * (std::pow(bands[near][b].change, 2) - v);
                            excess += e, squares += e * e, variances += w * v;
                        }
                    const double bias = std::max(0.0, excess - 1.5 * std::sqrt(squares)), total = bias + variances;
                    const double share = total > 0 ? bias / total : 0;
                    expected += share * bands[at][b].change;
                    least = std::min(least, share);
                    between += share > 0.01 && share < 0.99;
                }
                ASSERT_NEAR(done[at], std::max(0.0, expected), 2e-5) << x << " " << y << " " << level;
                if (level == 0 && least > 0) { // no noise: the input, but where nearly nothing was changed
                    ASSERT_NEAR(done[at], noisy[at], 1e-6);
                }
                if (level > 1) { // nothing but noise: the network
                    ASSERT_EQ(done[at], denoised[at]);
                }
            }
    }
    EXPECT_GT(between, 1000u);
}

TEST(Denoiser, KeepsLightThatTheFeatureRaysMissedAsFarAsItHasConverged) {
    Frame frame = noisy_frame(40, 30);
    for (const char* c : {"R", "G", "B"}) frame.channel(std::string("variance.") + c).assign(frame.pixels(), 1.0f);
    const std::size_t sure = 2 * 40 + 3, unsure = 2 * 40 + 9, half_seen = 2 * 40 + 15; // in the corner, where nothing is
    for (const std::size_t i : {sure, unsure, half_seen}) {
        ASSERT_EQ(frame.at("opacity.A")[i], 0);
        frame.channel("A")[i] = 0.5f;
        for (const char* c : {"R", "G", "B"}) {
            frame.channel(c)[i] = 0.016f;
            frame.channel(std::string("variance.") + c)[i] = i == unsure ? 0.016f * 0.016f : 1e-9f;
        }
    }
    frame.channel("opacity.A")[half_seen] = 0.125f;
    const Device device = test_device();
    const Frame done = Denoiser(device, test_model()).denoise(frame);
    EXPECT_NEAR(done.at("G")[sure], 0.016, 1e-5);
    EXPECT_NEAR(done.at("A")[sure], 0.5, 1e-4);
    EXPECT_EQ(done.at("A")[unsure], 0);
    EXPECT_LT(done.at("G")[unsure], 1e-6);
    EXPECT_GT(done.at("A")[half_seen], 0.2);
    EXPECT_LT(done.at("A")[half_seen], 0.4);
    // Under a background, what is there hides it.
    for (const char* c : {"R", "G", "B"}) {
        frame.channel(std::string("background.") + c).assign(frame.pixels(), 1.0f);
        for (std::size_t i = 0; i < frame.pixels(); ++i) frame.channel(c)[i] += 1 - frame.at("A")[i];
    }
    EXPECT_NEAR(Denoiser(device, test_model()).denoise(frame).at("G")[sure], 0.016 + 0.5, 1e-4);
}

Model light_model() {
    Model m = test_model();
    m.control_variate = true;
    m.channels.push_back("known.G");
    initialise(m, 5);
    return m;
}

TEST(Denoiser, ReturnsWhatIsKnownOfTheLight) {
    Frame frame = noisy_frame(60, 44);
    for (const char* c : {"R", "G", "B"})
        for (std::size_t i = 0; i < frame.pixels(); ++i)
            frame.channel(c)[i] = frame.at(std::string("light.key.") + c)[i] + frame.at(std::string("light.sky.") + c)[i];
    const Frame done = Denoiser(test_device(), light_model()).denoise(frame);
    for (const char* c : {"R", "G", "B"})
        for (std::size_t i = 0; i < frame.pixels(); ++i) ASSERT_NEAR(done.at(c)[i], frame.at(c)[i], 2e-5) << c << i;
}

TEST(Denoiser, WithKnownLightGivesTheSameBitsInTiles) {
    const Frame frame = noisy_frame(140, 170);
    const std::string hash = denoised_hash({}, frame, light_model());
    EXPECT_EQ(denoised_hash({{"denoise_mib", 10}}, frame, light_model()), hash);
    for (const int width : {1, 8}) EXPECT_EQ(denoised_hash({{"conv_width", width}}, frame, light_model()), hash) << width;
}

/// A film with a frame's channels, in another order than any plan's.
Film film_of(const Device& device, const Frame& frame, int samples) {
    Film film(device, frame.width, frame.height);
    film.require({"R", "G", "B", "A", "variance.R", "variance.G", "variance.B"});
    for (const char* c : {"light.sky.", "light.key.", "albedo."})
        film.require({c + std::string("R"), c + std::string("G"), c + std::string("B")});
    for (const auto& [name, values] : frame.channels) {
        if (film.find(name) < 0) film.require({name});
        film.upload(name, values);
    }
    film.samples = samples;
    return film;
}

TEST(Denoiser, GivesAFilmTheBitsOfItsFrame) {
    Frame frame = noisy_frame(83, 61);
    for (const char* c : {"R", "G", "B"}) frame.channel(std::string("variance.") + c).assign(frame.pixels(), 0.02f);
    frame.attributes["clvr.spp"] = "4";
    for (const bool light : {false, true}) {
        Model model = light ? light_model() : test_model();
        model.channels.push_back("noise");
        initialise(model, 5);
        Device device = test_device();
        Denoiser denoiser(device, model);
        const Frame expected = denoiser.denoise(frame);
        Film film = film_of(device, frame, 4);
        for (int again = 0; again < 2; ++again) { // planes are there already the second time
            denoiser.denoise(film);
            EXPECT_TRUE(film.denoised);
            for (const char* name : {"R", "G", "B", "A", "noisy.R", "noisy.A", "albedo.G", "opacity.A"})
                EXPECT_EQ(film.download(name), expected.at(name)) << name << again;
            for (const char* name : {"R", "G", "B", "A"}) film.upload(name, frame.at(name));
        }
    }
}

/// The result's alpha takes the place of the noisy one: a network that reads A must get what the frame has there.
TEST(Denoiser, ReadsTheNoisyAlphaThatTheFrameHas) {
    Frame frame = noisy_frame(83, 61);
    for (float& a : frame.channel("A")) a = 0.25f + 0.5f * a;
    frame.channel("depth.half") = frame.at("A");
    Model alpha = test_model(), other = alpha;
    alpha.channels.push_back("A"), other.channels.push_back("depth.half");
    initialise(alpha, 5), initialise(other, 5);
    Device device = test_device();
    const Frame expected = Denoiser(device, other).denoise(frame);
    EXPECT_EQ(Denoiser(device, alpha).denoise(frame).at("R"), expected.at("R"));
    Film film = film_of(device, frame, 1);
    Denoiser(device, alpha).denoise(film);
    EXPECT_EQ(film.download("R"), expected.at("R"));
}

TEST(Denoiser, ReadsNoVarianceOfOneSample) {
    Frame frame = noisy_frame(40, 30);
    Device device = test_device();
    Denoiser denoiser(device, test_model());
    const Frame expected = denoiser.denoise(frame);
    for (const char* c : {"R", "G", "B"}) frame.channel(std::string("variance.") + c).assign(frame.pixels(), 1e-9f);
    Film film = film_of(device, frame, 1);
    denoiser.denoise(film);
    EXPECT_EQ(film.download("R"), expected.at("R"));
}

TEST(Denoiser, RefusesAFilmThatLacksAChannel) {
    Frame frame = noisy_frame(20, 20);
    for (const char* c : {"R", "G", "B"}) frame.channel(std::string("variance.") + c);
    frame.channels.erase("normal.Y");
    Device device = test_device();
    Film film = film_of(device, frame, 1);
    try {
        Denoiser(device, test_model()).denoise(film);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::input);
        EXPECT_THAT(e.what(), ::testing::HasSubstr("lacks channel normal.Y"));
    }
}

TEST(Denoiser, NeverSeesTheBackground) {
    Frame frame = noisy_frame(60, 44), laid = frame;
    for (const char* c : {"R", "G", "B"}) {
        laid.channel(std::string("background.") + c).assign(frame.pixels(), 0.5f);
        for (std::size_t i = 0; i < frame.pixels(); ++i) laid.channel(c)[i] += (1 - frame.at("A")[i]) * 0.5f;
        for (Frame* f : {&frame, &laid}) f->channel(std::string("variance.") + c).assign(frame.pixels(), 0.02f);
    }
    Device device = test_device();
    Denoiser denoiser(device, test_model());
    const Frame a = denoiser.denoise(frame), b = denoiser.denoise(laid);
    for (std::size_t i = 0; i < frame.pixels(); ++i) ASSERT_NEAR(a.at("R")[i] + (1 - frame.at("A")[i]) * 0.5f, b.at("R")[i], 1e-6);
}

TEST(Denoiser, NamesTheChannelThatIsMissing) {
    Frame frame = noisy_frame(20, 20);
    frame.channels.erase("normal.Y");
    Device device = test_device();
    try {
        Denoiser(device, test_model()).denoise(frame);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::input);
        EXPECT_THAT(e.what(), ::testing::AllOf(::testing::HasSubstr("lacks channel normal.Y"), ::testing::HasSubstr("albedo.B")));
    }
}

TEST(Denoiser, ShowsWhatTheNetworkMade) {
    Device device = test_device();
    const Frame frame = noisy_frame(40, 30);
    const Frame done = Denoiser(device, test_model()).denoise(frame, {true, true, true});
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const float w1 = done.at("weight.1")[i], w2 = done.at("weight.2")[i];
        ASSERT_TRUE(w1 > 0 && w1 < 1 && done.at("guide.3")[i] > 0 && done.at("guide.3")[i] < 1);
        const float blended = w1 * done.at("level1.G")[i] + w2 * done.at("level2.G")[i] + (1 - w1 - w2) * done.at("level3.G")[i];
        ASSERT_NEAR(done.at("G")[i], std::max(blended, 0.0f), 1e-5);
    }
}

/// The dihedral transforms of the crops (kernels/denoise/README.md, "Training").
TEST(Assemble, TurnsAsTheGoldenVectorsDo) {
    const Golden golden("augment");
    const std::vector<double> image = golden["image"]; // [3, 4, 2]
    Model model;
    model.channels = {"R", "G", "B"};
    initialise(model, 1);
    const ChannelPlan plan(model, false);
    for (const int lanes : {1, 16}) {
        Device device = test_device();
        device.set_tunable("conv_width", lanes);
        std::vector<float> planes;
        for (int c = 0; c < 3; ++c)
            for (int i = 0; i < 12; ++i) planes.push_back(static_cast<float>(image[2 * i + c % 2]));
        const Buffer source = device.upload(planes, "source");
        for (int k = 0; k < 8; ++k) {
            const std::vector<double> want = golden["aug" + std::to_string(k)];
            const std::vector<std::int64_t> shape = golden.shape("aug" + std::to_string(k));
            NeuralGrid grid(device, model, {static_cast<int>(shape[1]), static_cast<int>(shape[0])});
            grid.assemble(source, 4, 3, plan.params(1, 1), 0, 0, k, 0);
            const auto pixels = device.download<shared::float4>(grid.splatted(), 12);
            for (int i = 0; i < 12; ++i) {
                EXPECT_EQ(pixels[i].x, static_cast<float>(want[2 * i])) << k;
                EXPECT_EQ(pixels[i].y, static_cast<float>(want[2 * i + 1])) << k;
            }
        }
    }
}

TEST(Assemble, TonemapMeetsTheGoldenVectors) {
    const Golden golden("tonemap");
    const std::vector<float> x = golden.floats("x");
    Model model;
    model.channels = {"R", "G", "B"};
    initialise(model, 1);
    Device device = test_device();
    std::vector<float> planes;
    for (int c = 0; c < 3; ++c) planes.insert(planes.end(), x.begin(), x.end());
    NeuralGrid grid(device, model, {static_cast<int>(x.size()), 1});
    grid.assemble(device.upload(planes, "source"), static_cast<int>(x.size()), 1, ChannelPlan(model, false).params(1, 1), 0, 0, 0, 0);
    golden.expect_near("y", interleaved(grid, grid.input(), 3, 0, 1));
}

} // namespace
} // namespace clvr::testing
