// Training: gradients against finite differences, the same bits however the work is divided, interruption, overfitting, what is refused.
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/pairs/folder.hpp"
#include "host/train/checkpoint.hpp"
#include "host/train/trainer.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "tests/denoise/batches.hpp"
#include "tests/runtime/faulty_devices.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace clvr::testing {
namespace {

using ::testing::HasSubstr;

struct Noise {
    std::uint32_t k = 1;
    float operator()() {
        k = k * 1664525u + 1013904223u;
        return static_cast<float>(k >> 8) / (1 << 24);
    }
};

/// A picture of two materials, and its noisy version with features.
std::pair<Frame, Frame> pair_of(int size, std::uint32_t seed, float amount = 1) {
    Noise noise{seed};
    Frame noisy, clean;
    noisy.width = noisy.height = clean.width = clean.height = size;
    for (const auto& name : reference_channels()) noisy.channel(name);
    for (const char* c : {"R", "G", "B"}) clean.channel(c);
    noisy.channel("opacity.A").assign(noisy.pixels(), 1.0f);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * size + x;
            const bool right = x + y / 3 > size / 2;
            int k = 0;
            for (const char* c : {"R", "G", "B"}) {
                const float v = right ? 0.6f - 0.1f * static_cast<float>(k) : 0.15f + 0.1f * static_cast<float>(k);
                clean.channel(c)[i] = v;
                noisy.channel(c)[i] = v * (1 + amount * (2 * noise() - 1));
                noisy.channel(std::string("albedo.") + c)[i] = right ? 0.8f : 0.4f;
                ++k;
            }
            noisy.channel("normal.X")[i] = right ? 0.7f : -0.7f;
            noisy.channel("depth.Z")[i] = right ? 0.25f : 0.75f;
        }
    return {noisy, clean};
}

Model start_model() {
    Model m;
    m.channels = reference_channels();
    m.exposure = m.opacity_weight = true;
    m.albedo_floor = 1.0f / 32;
    initialise(m, 3);
    return m;
}

struct LossCase : ::testing::TestWithParam<Loss> {};

/// The gradient against central differences of the float loss along random directions.
TEST_P(LossCase, GradientIsTheSlopeOfTheLoss) {
    StepConfig config;
    config.loss = GetParam();
    config.patch = 24;
    config.batch = 2;
    Device device = test_device();
    Model model = start_model();
    TrainingStep step(device, model, config);
    for (std::uint32_t n = 0; n < 2; ++n) {
        const auto [noisy, clean] = pair_of(32, 5 + n, 0.8f);
        step.add_image(noisy, clean);
    }
    const std::vector<Crop> crops{{0, 3, 5, 1}, {1, 8, 0, 6}};
    std::vector<float> gradient, unused;
    step.gradient(crops, gradient);
    Noise noise{99};
    OptimizerState state = step.state();
    const std::vector<float> start = state.parameters;
    for (int k = 0; k < 6; ++k) {
        std::vector<float> direction(start.size());
        double slope = 0, norm = 0;
        // Along the gradient and noise of the same size, so that the change is above rounding.
        for (float g : gradient) norm += g * g;
        for (std::size_t i = 0; i < start.size(); ++i) {
            direction[i] =
                static_cast<float>(gradient[i] / std::sqrt(norm) + (noise() - 0.5f) * 2 / std::sqrt(static_cast<double>(start.size())));
            slope += direction[i] * gradient[i];
        }
        constexpr float h = 1e-4f;
        double side[2];
        for (int sign = 0; sign < 2; ++sign) {
            for (std::size_t i = 0; i < start.size(); ++i) state.parameters[i] = start[i] + (sign ? h : -h) * direction[i];
            step.set_state(state);
            side[sign] = step.gradient(crops, unused);
        }
        double found = (side[1] - side[0]) / (2 * h);
        if (GetParam() == Loss::noisy) continue; // its slope leaves out the denominator, on purpose
        EXPECT_NEAR(found, slope, 0.03 * std::abs(slope)) << k;
    }
}
INSTANTIATE_TEST_SUITE_P(Losses, LossCase,
                         ::testing::Values(Loss::shifted_gamma, Loss::reference, Loss::smape, Loss::relative_l2, Loss::noisy,
                                           Loss::shifted_gamma_l2, Loss::shifted_gamma_bands));

std::vector<float> trained(int micro_batch, const std::map<std::string, int>& tunables, std::size_t memory = 0,
                           std::vector<Device> devices = {test_device()}) {
    StepConfig config;
    config.patch = 24;
    config.batch = 5;
    config.micro_batch = micro_batch;
    for (Device& device : devices) {
        for (const auto& [name, value] : tunables) device.set_tunable(name, value);
        if (memory > 0) device.set_memory_limit(memory);
    }
    TrainingStep step(devices, start_model(), config);
    for (std::uint32_t n = 0; n < 2; ++n) {
        const auto [noisy, clean] = pair_of(40, 5 + n);
        step.add_image(noisy, clean);
    }
    for (int k = 0; k < 3; ++k) step.step({{0, k, 2, 0}, {1, 7, k, 3}, {0, 16, 16, 5}, {1, 0, 0, 7}, {0, 4, 9, 2}}, 1e-3);
    return step.state().parameters;
}

TEST(TrainingBits, DoNotDependOnMicroBatchesWidthsOrMemory) {
    const std::vector<float> whole = trained(5, {});
    EXPECT_NE(whole, start_model().flat());
    EXPECT_EQ(trained(1, {}), whole);
    EXPECT_EQ(trained(2, {}), whole);
    EXPECT_EQ(trained(5, {{"conv_width", 1}}), whole);
    EXPECT_EQ(trained(3, {{"conv_width", 8}, {"splat_bins", 5}}), whole);
    EXPECT_EQ(trained(0, {}, std::size_t{6} << 20), whole); // images stay on the host where the device is full
}

TEST(TrainingBits, DoNotDependOnTheDevices) {
    const std::vector<float> alone = trained(2, {});
    EXPECT_EQ(trained(1, {}, 0, open_two_devices()), alone);                                      // in one context
    EXPECT_EQ(trained(2, {}, 0, {test_device(), test_device()}), alone);                          // in two
    EXPECT_EQ(trained(0, {{"conv_width", 8}}, std::size_t{14} << 20, open_two_devices()), alone); // images stay on the host
}

TEST(Training, SeveralDevicesGiveTheGradientAndLossesOfOne) {
    StepConfig config;
    config.patch = 24;
    config.batch = 7;
    config.micro_batch = 1;
    TrainingStep one(two_devices().front(), start_model(), config), two(two_devices(), start_model(), config);
    const auto [noisy, clean] = pair_of(40, 8);
    for (TrainingStep* step : {&one, &two}) step->add_image(noisy, clean);
    std::vector<Crop> crops;
    for (int k = 0; k < 7; ++k) crops.push_back({0, k, 2 * k, k});
    std::vector<float> gradient_of_one, gradient_of_two;
    EXPECT_EQ(one.gradient(crops, gradient_of_one), two.gradient(crops, gradient_of_two));
    EXPECT_EQ(gradient_of_one, gradient_of_two);
    for (int k = 0; k < 3; ++k)
        for (TrainingStep* step : {&one, &two}) step->step(crops, 1e-3);
    EXPECT_EQ(one.take_losses(), two.take_losses());
    EXPECT_TRUE(two.take_losses().empty());
    EXPECT_EQ(one.state().second_moment, two.state().second_moment);
    EXPECT_EQ(two.state().step, 3);
    EXPECT_EQ(one.model().flat(), two.model().flat());
}

TEST(Training, ClblastTakesOneDevice) {
    StepConfig config;
    config.convolution = ConvolutionBackend::clblast;
    try {
        TrainingStep(two_devices(), start_model(), config);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::usage);
    }
}

TEST(Training, OverfitsASmallFrame) {
    StepConfig config;
    config.patch = 32;
    config.batch = 1;
    Device device = test_device();
    TrainingStep step(device, start_model(), config);
    const auto [noisy, clean] = pair_of(32, 11, 0.5f);
    step.add_image(noisy, clean);
    const std::vector<Crop> crops{{0, 0, 0, 0}};
    for (int k = 0; k < 300; ++k) step.step(crops, 3e-3);
    const std::vector<double> losses = step.take_losses();
    ASSERT_EQ(losses.size(), 300u);
    EXPECT_LT(losses.back(), 0.4 * losses.front());
}

TEST(Training, ClipsTheNormOfAGradient) {
    Device device = test_device();
    const auto [noisy, clean] = pair_of(24, 1);
    std::vector<float> gradient;
    double norm = 0;
    for (const double clip : {0.0, 1e-4}) {
        StepConfig config;
        config.patch = 24;
        config.batch = 1;
        config.clip_norm = clip;
        TrainingStep step(device, start_model(), config);
        step.add_image(noisy, clean);
        step.step({{0, 0, 0, 0}}, 1e-3);
        double sum = 0;
        for (const float m : step.state().first_moment) sum += m * m / 0.01; // m = 0.1 g after the first step
        if (clip > 0) {
            EXPECT_GT(norm, 1e-4);
            EXPECT_NEAR(std::sqrt(sum), 1e-4, 1e-8);
        }
        norm = std::sqrt(sum);
    }
}

class TrainerFiles : public ::testing::Test {
protected:
    TemporaryFolder folder;
    Device device = test_device();
    std::vector<Device> devices{device};

    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    /// A folder of three views, as `clvr pairs` would leave it.
    std::string pairs(const std::string& name, int frames = 1, int reference_spp = 64) {
        std::filesystem::create_directories(folder.path() / name);
        std::string views;
        for (int v = 0; v < 3; ++v) {
            views += v ? ",{}" : "{}";
            for (int k = 0; k < frames; ++k) {
                const auto [noisy, clean] = pair_of(40, static_cast<std::uint32_t>(20 + 10 * v + k));
                write_exr(noisy, path(name + "/" + noisy_name(v, k)));
                if (reference_spp > 0) write_exr(clean, path(name + "/" + reference_name(v)));
            }
        }
        folder.write(name + "/pairs.json", R"({"clvr.format": "pairs/1", "split": "train", "noisy_frames": )" + std::to_string(frames) +
                                               R"(, "reference_spp": )" + std::to_string(reference_spp) + R"(, "views": [)" + views + "]}");
        return path(name);
    }
    TrainerConfig config() const {
        TrainerConfig c;
        c.step.patch = 24;
        c.step.batch = 4;
        c.patches_per_image = 5;
        c.epochs = 3;
        c.learning_rate = 1e-3;
        c.cosine = true;
        return c;
    }
    std::string read_tensors_configuration(const std::string& name) const {
        return nlohmann::json::parse(read_tensors(path(name)).metadata.at("clvr.checkpoint")).at("configuration");
    }
    /// Trains until `steps` more steps were reported (0: to the end).
    bool train(const TrainerConfig& c, const std::string& output, bool resume, int stop_after_reports = 0,
               const std::string& validate = {}) {
        std::atomic<bool> cancelled{false};
        int reports = 0;
        Trainer trainer(devices, start_model(), c, {path("train")}, validate, path(output), resume);
        return trainer.run(cancelled, [&](const TrainerProgress&) {
            if (++reports == stop_after_reports) cancelled = true;
        });
    }
};

TEST_F(TrainerFiles, ResumedTrainingGivesTheSameFile) {
    pairs("train");
    ASSERT_TRUE(train(config(), "whole.safetensors", false));
    ASSERT_FALSE(train(config(), "cut.safetensors", false, 1));
    // What SIGKILL leaves: files of the last checkpoint. Whatever the others are, the checkpoint alone is read.
    std::filesystem::remove(path("cut.safetensors"));
    ASSERT_TRUE(train(config(), "cut.safetensors", true));
    EXPECT_EQ(read_text(path("whole.safetensors")), read_text(path("cut.safetensors")));
    EXPECT_EQ(read_text(path("whole.checkpoint")), read_text(path("cut.checkpoint")));
    EXPECT_EQ(read_text(path("whole.training.csv")), read_text(path("cut.training.csv")));
    ASSERT_TRUE(train(config(), "again.safetensors", false));
    EXPECT_EQ(read_text(path("whole.safetensors")), read_text(path("again.safetensors")));
}

TEST_F(TrainerFiles, EndsAfterItsSteps) {
    pairs("train"); // 15 patches in batches of 4: 4 steps an epoch
    TrainerConfig c = config();
    c.steps = 10;
    ASSERT_TRUE(train(c, "whole.safetensors", false));
    EXPECT_EQ(read_checkpoint(path("whole.checkpoint"), read_tensors_configuration("whole.checkpoint")).state.step, 10);
    const std::string csv = read_text(path("whole.training.csv"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3); // the third epoch is half a one
    ASSERT_FALSE(train(c, "cut.safetensors", false, 3));
    ASSERT_TRUE(train(c, "cut.safetensors", true));
    EXPECT_EQ(read_text(path("whole.safetensors")), read_text(path("cut.safetensors")));
    EXPECT_EQ(csv, read_text(path("cut.training.csv")));
    // A finished training has nothing left to do, and writes its files again where they were lost.
    std::filesystem::remove(path("cut.safetensors"));
    ASSERT_TRUE(train(c, "cut.safetensors", true));
    EXPECT_EQ(read_text(path("whole.safetensors")), read_text(path("cut.safetensors")));
    c.steps = 12;
    EXPECT_THROW(train(c, "cut.safetensors", true), Error); // another training
    // Steps that are whole epochs are the same as those.
    ASSERT_TRUE(train(c, "steps.safetensors", false));
    ASSERT_TRUE(train(config(), "epochs.safetensors", false));
    EXPECT_EQ(read_model(path("steps.safetensors")).flat(), read_model(path("epochs.safetensors")).flat());
}

TEST_F(TrainerFiles, OtherDevicesGiveTheSameFile) {
    pairs("train");
    ASSERT_TRUE(train(config(), "one.safetensors", false, 0, path("train")));
    devices = two_devices();
    ASSERT_TRUE(train(config(), "two.safetensors", false, 0, path("train")));
    ASSERT_FALSE(train(config(), "resumed.safetensors", false, 1, path("train")));
    devices = {device};
    ASSERT_TRUE(train(config(), "resumed.safetensors", true, 0, path("train")));
    for (const char* ending : {".safetensors", ".checkpoint", ".training.csv"})
        for (const char* name : {"two", "resumed"})
            EXPECT_EQ(read_text(path(std::string("one") + ending)), read_text(path(std::string(name) + ending))) << name << ending;
}

TEST_F(TrainerFiles, FaultyDevicesAreLeftOutOrWaitedFor) {
    if (faulty_devices("delay:1").empty()) GTEST_SKIP() << "the device has no parts";
    pairs("train");
    ASSERT_TRUE(train(config(), "one.safetensors", false, 0, path("train")));
    const auto expect_same_with = [&](const std::string& fault, int part, long warned, int delay_ms = 0) {
        SCOPED_TRACE(fault);
        const Warnings warnings;
        devices = faulty_devices(fault, part, delay_ms);
        ASSERT_TRUE(train(config(), "faulty.safetensors", false, 0, path("train")));
        EXPECT_EQ(lines_of(warnings.text()), warned) << warnings.text();
        for (const char* ending : {".safetensors", ".checkpoint", ".training.csv"})
            EXPECT_EQ(read_text(path(std::string("one") + ending)), read_text(path(std::string("faulty") + ending))) << ending;
    };
    expect_same_with("delay:3", 2, 0);
    for (const char* fault : {"launch:30", "alloc:20"}) expect_same_with(fault, 2, 1);
    expect_same_with("launch:120", 2, 1, 2); // within a step
    // The first one, which sums and takes the steps; after it has taken some, within a step.
    for (const char* fault : {"launch:37", "launch:150"}) expect_same_with(fault, 1, 1);
    for (const auto& [fault, kind] : {std::pair("build:train/adam", ErrorKind::device), {"alloc:20", ErrorKind::device_memory}}) {
        const Warnings warnings;
        devices = faulty_devices(fault, 0);
        try {
            train(config(), "none.safetensors", false);
            FAIL();
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), kind) << e.line();
        }
    }
    devices = faulty_devices("result:train/sum_lanes");
    try {
        train(config(), "none.safetensors", false);
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.line(), HasSubstr("compute different gradients"));
    }
}

TEST_F(TrainerFiles, KeepsTheBestModelAndTheLast) {
    pairs("train");
    ASSERT_TRUE(train(config(), "m.safetensors", false, 0, path("train")));
    const Checkpoint c = [&] {
        const TensorFile file = read_tensors(path("m.checkpoint"));
        EXPECT_NE(file.find("best.conv1.weight"), nullptr);
        Checkpoint k;
        k.state.parameters = read_model(path("m.last.safetensors")).flat();
        return k;
    }();
    EXPECT_EQ(c.state.parameters.size(), start_model().parameters());
    EXPECT_THAT(read_text(path("m.training.csv")), HasSubstr("epoch,loss,validation_psnr\n1,"));
}

TEST_F(TrainerFiles, RefusesTheCheckpointOfAnotherTraining) {
    pairs("train");
    TrainerConfig c = config();
    c.epochs = 1;
    ASSERT_TRUE(train(c, "m.safetensors", false));
    c.learning_rate = 0.5;
    EXPECT_THROW(train(c, "m.safetensors", true), Error);
    c = config();
    c.epochs = 1;
    c.step.convolution = ConvolutionBackend::clblast; // its sums have another order
    EXPECT_THROW(train(c, "m.safetensors", true), Error);
    EXPECT_THROW(train(config(), "none.safetensors", true), Error);
    const std::string whole = read_text(path("m.checkpoint"));
    folder.write("m.checkpoint", whole.substr(0, whole.size() / 2));
    EXPECT_THROW(train(c, "m.safetensors", true), Error);
}

TEST_F(TrainerFiles, StopsWhenTheLossIsNoNumber) {
    pairs("train");
    TrainerConfig c = config();
    c.cosine = false;
    c.epochs = 1;
    ASSERT_TRUE(train(c, "m.safetensors", false));
    const std::string before = read_text(path("m.checkpoint"));
    c.learning_rate = 1e38;
    try {
        train(c, "m.safetensors", false);
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("NaN at step"));
    }
    EXPECT_EQ(read_text(path("m.checkpoint")), before);
}

TEST_F(TrainerFiles, TrainsOnNoisyTargets) {
    pairs("train", 2, 0);
    TrainerConfig c = config();
    EXPECT_THROW(train(c, "m.safetensors", false), Error); // no references
    c.step.loss = Loss::noisy;
    EXPECT_TRUE(train(c, "m.safetensors", false));
}

TEST_F(TrainerFiles, RefusesFoldersThatCannotServe) {
    EXPECT_THROW(read_pairs(path("none")), Error);
    pairs("train");
    std::filesystem::remove(folder.path() / "train" / reference_name(1));
    try {
        read_pairs(path("train"));
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.line(), HasSubstr("lacks view_0001_reference.exr"));
    }
    folder.write("train/pairs.json", "{");
    EXPECT_THROW(read_pairs(path("train")), Error);
    pairs("train");
    TrainerConfig c = config();
    c.step.patch = 41;
    try {
        train(c, "m.safetensors", false);
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.line(), HasSubstr("smaller than a patch of 41"));
    }
    write_exr(pair_of(48, 1).second, path("train/" + reference_name(2)));
    try {
        train(config(), "m.safetensors", false);
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.line(), HasSubstr("is 40 x 40 pixels, its target 48 x 48"));
        EXPECT_THAT(e.line(), HasSubstr(noisy_name(2, 0)));
    }
}

TEST_F(TrainerFiles, OneImageIsEnoughAndNoneIsNot) {
    std::filesystem::create_directories(folder.path() / "one");
    const auto [noisy, clean] = pair_of(40, 3);
    write_exr(noisy, path("one/" + noisy_name(0, 0)));
    write_exr(clean, path("one/" + reference_name(0)));
    const auto describe = [&](const std::string& views) {
        folder.write("one/pairs.json",
                     R"({"clvr.format": "pairs/1", "split": "train", "noisy_frames": 1, "reference_spp": 4, "views": [)" + views + "]}");
    };
    describe("{}");
    TrainerConfig c = config();
    c.epochs = 1;
    EXPECT_TRUE(
        Trainer({device}, start_model(), c, {path("one")}, "", path("one.safetensors"), false).run({}, [](const TrainerProgress&) {}));
    describe("");
    EXPECT_THROW(Trainer({device}, start_model(), c, {path("one")}, "", path("one.safetensors"), false), Error);
}

TEST_F(TrainerFiles, RefusesABatchThatCannotFit) {
    pairs("train");
    TrainerConfig c = config();
    c.step.batch = 50000; // whose gradients alone take 1.5 GB
    device.set_memory_limit(std::size_t{1} << 30);
    try {
        train(c, "m.safetensors", false);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::device_memory);
    }
}

TEST(EpochCrops, CoverEveryOffsetAndOrientation) {
    const auto crops = epoch_crops(4, 2, {{20, 30}, {16, 16}}, 3, 4000, 16, true);
    ASSERT_EQ(crops.size(), 8000u);
    int corner = 0, orientations[8]{}, images[6]{};
    for (const auto& c : crops) {
        const bool first = c.image < 3;
        ASSERT_TRUE(c.x >= 0 && c.y >= 0 && c.x <= (first ? 4 : 0) && c.y <= (first ? 14 : 0));
        corner += first && c.x == 4 && c.y == 14;
        ++orientations[c.orientation], ++images[c.image];
    }
    EXPECT_NEAR(corner, 4000.0 / (5 * 15), 30);
    for (const int n : orientations) EXPECT_NEAR(n, 1000, 130);
    for (const int n : images) EXPECT_NEAR(n, 1333, 150);
    EXPECT_EQ(crops[17].x, epoch_crops(4, 2, {{20, 30}, {16, 16}}, 3, 4000, 16, true)[17].x);
    const auto other = epoch_crops(4, 3, {{20, 30}, {16, 16}}, 3, 4000, 16, true);
    EXPECT_TRUE(std::any_of(crops.begin(), crops.end(), [&](const Crop& c) { return c.x != other[&c - crops.data()].x; }));
}

} // namespace
} // namespace clvr::testing
