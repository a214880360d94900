// The backward kernels and the optimiser.
#include "host/selftest/check.hpp"
#include "host/selftest/golden.hpp"
#include "host/train/training_step.hpp"
#include "runtime/system/hashes.hpp"

#include <fmt/format.h>

#include <cmath>

namespace clvr::selftest {
namespace {

constexpr int patch = 16;

StepConfig config_with(Loss loss) {
    StepConfig config;
    config.loss = loss;
    config.patch = patch;
    config.batch = 2;
    return config;
}

/// Makes the golden frame with a smooth target known to the step.
void add_golden_image(TrainingStep& step) {
    const Frame noisy = golden_noisy_frame();
    Frame target = noisy;
    int n = 0;
    for (const char* c : {"R", "G", "B"})
        for (float& v : target.channel(c)) v = static_cast<float>(n++ % 70) / 140 + 0.25f;
    step.add_image(noisy, target);
}

const std::vector<Crop> crops{{0, 20, 10, 0}, {0, 31, 17, 3}};

} // namespace

Outcome check_gradient(Device& device) {
    constexpr double step = 1e-3, tolerance = 0.01; // length of the difference's arm; floats leave 2e-3
    Model network = golden_network();
    network.levels = {{4, 128}, {8, 256}}; // few codes: a cell's borders, where the loss has kinks, are far between
    initialise(network, 5);
    TrainingStep training_step(device, network, config_with(Loss::relative_l2));
    add_golden_image(training_step);
    std::vector<float> gradient, unused;
    training_step.gradient(crops, gradient);
    OptimizerState state = training_step.state();
    const std::vector<float> start = state.parameters;
    const std::pair<const char*, std::size_t> tensors[] = {{"conv1.weight", network.conv1_weight.size()},
                                                           {"conv1.bias", network.conv1_bias.size()},
                                                           {"conv2.weight", network.conv2_weight.size()},
                                                           {"conv2.bias", network.conv2_bias.size()}};
    bool ok = true;
    std::string found;
    std::size_t first = 0;
    for (const auto& [name, count] : tensors) {
        const std::size_t end = first + count; // a lambda may not capture `count` (C++17, and clang says so)
        double squares = 0;
        for (std::size_t i = first; i < end; ++i) squares += static_cast<double>(gradient[i]) * gradient[i];
        const double norm = std::sqrt(squares);
        const auto loss_at = [&](double by) {
            state.parameters = start;
            for (std::size_t i = first; i < end; ++i) state.parameters[i] += static_cast<float>(by * gradient[i] / norm);
            training_step.set_state(state);
            return training_step.gradient(crops, unused);
        };
        const double slope = (loss_at(step) - loss_at(-step)) / (2 * step), share = slope / norm;
        ok &= norm > 0 && std::abs(share - 1) <= tolerance;
        found += fmt::format("{}{} {:.4f}", found.empty() ? "" : ", ", name, share);
        first = end;
    }
    return {ok, fmt::format("slope over gradient 1 within {}", tolerance), found};
}

Outcome check_training(Device& device) {
    constexpr int steps = 6;
    TrainingStep training_step(device, tiny_network(), config_with(Loss::shifted_gamma));
    add_golden_image(training_step);
    for (int i = 0; i < steps; ++i) training_step.step(crops, 0.01);
    std::string bytes;
    const auto append = [&](const auto& values) {
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]);
    };
    append(training_step.take_losses());
    append(training_step.state().parameters);
    const std::string found = sha256_hex(bytes);
    return {found == golden_training_hash, golden_training_hash, found};
}

} // namespace clvr::selftest
