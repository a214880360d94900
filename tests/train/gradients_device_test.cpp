// The backward kernels against the double-precision reference, and that one against its own central differences.
#include "host/train/gradients.hpp"
#include "host/train/training_step.hpp"
#include "tests/denoise/batches.hpp"
#include "tests/denoise/frames.hpp"
#include "tests/reference/neural_grid.hpp"

namespace clvr::testing {
namespace {

struct Random01 {
    std::uint64_t k;
    double operator()() { // 0..1
        k = k * 6364136223846793005u + 1442695040888963407u;
        return static_cast<double>(k >> 11) * 0x1p-53;
    }
};

/// A network and an image of any shape, with features on and off.
struct Case {
    int width, height, hidden, kernel;
    std::vector<Model::Level> levels;
    std::vector<std::string> channels;
    bool preprocessing;
    bool control_variate = false;
};

const Case cases[] = {{23, 17, 20, 5, {{4, 4}, {8, 8}, {16, 16}}, reference_channels(), true},
                      {19, 33, 7, 3, {{3, 5}, {10, 64}}, {"R", "G", "B", "albedo.R", "depth.Z"}, false},
                      {16, 16, 10, 5, {{4, 4}, {8, 8}, {16, 16}}, reference_channels(), false},
                      {41, 9, 5, 1, {{8, 8}}, {"albedo.G", "normal.X"}, true},
                      {27, 21, 6, 3, {{4, 8}, {8, 16}}, {"R", "albedo.R", "albedo.G", "albedo.B", "known.G"}, true, true}};

Model model_of(const Case& c, std::uint64_t seed) {
    Model m;
    m.channels = c.channels;
    m.hidden = c.hidden;
    m.kernel = c.kernel;
    m.levels = c.levels;
    m.exposure = m.opacity_weight = c.preprocessing;
    m.control_variate = c.control_variate;
    m.albedo_floor = c.preprocessing ? 1.0f / 32 : 0x1p-20f;
    initialise(m, seed);
    Random01 random{seed};
    for (std::vector<float>* bias : {&m.conv1_bias, &m.conv2_bias})
        for (float& b : *bias) b = static_cast<float>(random() - 0.5);
    return m;
}

reference::Network network_of(const Model& m) {
    reference::Network n{static_cast<int>(m.channels.size()), m.hidden, m.kernel, {}, {}};
    for (const auto& l : m.levels) n.levels.emplace_back(l.pixels, l.codes);
    const std::vector<float> flat = m.flat();
    n.parameters.assign(flat.begin(), flat.end());
    return n;
}

/// Everything on the device, and what it assembled for the reference.
struct Setting {
    Device device;
    Model model;
    BatchShape shape;
    NeuralGrid grid;
    Buffer parameters;
    reference::GridImage image;

    Setting(const Case& c, std::uint64_t seed, int width_of_vectors = 0)
        : device(opened(width_of_vectors)), model(model_of(c, seed)), shape{c.width, c.height, 1, false, true}, grid(device, model, shape) {
        const Frame frame = noisy_frame(c.width, c.height);
        Frame target = frame;
        Random01 random{seed + 1};
        for (const char* name : {"R", "G", "B"})
            for (float& v : target.channel(name)) v = static_cast<float>(0.02 + 1.2 * random() * random());
        const ChannelPlan plan(model, true);
        std::vector<float> planes;
        plan.gather(frame, &target, {0, 0, c.width, c.height}, plan.known_light(frame), planes);
        const Buffer source = device.upload(planes, "source");
        parameters = device.upload(model.flat(), "parameters");
        grid.set_parameters(parameters);
        grid.assemble(source, c.width, c.height, plan.params(frame), 0, 0, 0, 0);

        image.height = c.height, image.width = c.width;
        const int channels = static_cast<int>(model.channels.size());
        for (int k = 0; k < channels; ++k)
            for (const float v : grid.download(grid.input(), channels, 0, k)) image.input.push_back(v);
        for (const auto& v : device.download<shared::float4>(grid.splatted(), frame.pixels()))
            image.splatted.insert(image.splatted.end(), {v.x, v.y, v.z, v.w});
        for (const auto& v : device.download<shared::float4>(grid.remodulation(), frame.pixels()))
            image.remodulation.insert(image.remodulation.end(), {v.x, v.y, v.z});
        image.target = interleaved(grid, grid.target(), 3, 0, 3);
        if (model.control_variate) image.known = interleaved(grid, grid.known(), 3, 0, 3);
    }

    std::vector<double> gradient(Loss loss) {
        Gradients gradients(device, model, loss, grid, shape);
        gradients.set_parameters(parameters);
        Buffer gradient = device.buffer(model.parameters() * 4, "gradient"), value = device.buffer(4, "loss");
        grid.forward(1);
        gradients.backward(grid, 1, static_cast<float>(1.0 / (3.0 * shape.width * shape.height)), gradient, value, 0);
        const std::vector<float> flat = device.download<float>(gradient, model.parameters());
        return {flat.begin(), flat.end()};
    }

private:
    static Device opened(int width) {
        Device d = test_device();
        if (width > 0) d.set_tunable("conv_width", width);
        return d;
    }
};

double norm(const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
}

constexpr std::pair<Loss, reference::GridLoss> losses[] = {{Loss::shifted_gamma, reference::GridLoss::shifted_gamma},
                                                           {Loss::reference, reference::GridLoss::reference},
                                                           {Loss::smape, reference::GridLoss::smape},
                                                           {Loss::relative_l2, reference::GridLoss::relative_l2},
                                                           {Loss::noisy, reference::GridLoss::noisy},
                                                           {Loss::shifted_gamma_l2, reference::GridLoss::shifted_gamma_l2},
                                                           {Loss::shifted_gamma_bands, reference::GridLoss::shifted_gamma_bands}};

TEST(GradientKernels, MeetTheDoublePrecisionReference) {
    for (const Case& c : cases)
        for (const int width : {1, 16}) {
            Setting s(c, 3, width);
            const reference::Network network = network_of(s.model);
            for (const auto& [loss, theirs] : losses) {
                const std::vector<double> got = s.gradient(loss);
                const reference::GridPass want = reference::backward(network, s.image, theirs);
                const std::vector<double> result = interleaved(s.grid, s.grid.result(), 3, 0, 3);
                for (std::size_t i = 0; i < result.size(); ++i) ASSERT_NEAR(result[i], want.result[i], 2e-4 * (1 + want.result[i])) << i;
                std::vector<double> off(got.size());
                for (std::size_t i = 0; i < got.size(); ++i) off[i] = got[i] - want.gradient[i];
                EXPECT_GT(norm(want.gradient), 0);
                EXPECT_LT(norm(off), 1e-3 * norm(want.gradient)) << c.width << "x" << c.height << " loss " << static_cast<int>(loss);
            }
        }
}

/// h = 1e-6 along 50 random directions of length 1; directions with a kink within 10 h are left out (few may be).
TEST(ReferenceGradient, IsTheSlopeOfItsLoss) {
    constexpr double h = 1e-6;
    for (const Case& c : cases) {
        const Setting s(c, 11);
        const reference::Network network = network_of(s.model);
        for (const auto& [unused, loss] : losses) {
            if (loss == reference::GridLoss::noisy) continue; // its slope leaves out the denominator, on purpose
            const reference::GridPass at = reference::backward(network, s.image, loss);
            Random01 random{77};
            int tried = 0, checked = 0;
            while (checked < 50 && tried < 200) {
                ++tried;
                std::vector<double> direction(network.parameters.size());
                for (double& d : direction) d = random() + random() + random() - 1.5;
                const double length = norm(direction);
                double slope = 0;
                for (std::size_t i = 0; i < direction.size(); ++i) slope += at.gradient[i] * (direction[i] /= length);
                const auto moved = [&](double by) {
                    reference::Network n = network;
                    for (std::size_t i = 0; i < direction.size(); ++i) n.parameters[i] += by * direction[i];
                    return reference::forward(n, s.image, loss);
                };
                if (moved(10 * h).sides != at.sides || moved(-10 * h).sides != at.sides) continue;
                const double found = (moved(h).loss - moved(-h).loss) / (2 * h);
                // A direction across the gradient has a slope near 0: rounding then is measured by the gradient.
                ASSERT_NEAR(found, slope, 1e-4 * std::max(std::abs(slope), 1e-2 * norm(at.gradient)))
                    << c.width << "x" << c.height << " loss " << static_cast<int>(loss);
                ++checked;
            }
            EXPECT_EQ(checked, 50) << tried;
        }
    }
}

} // namespace
} // namespace clvr::testing
