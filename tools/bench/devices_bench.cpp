// clvr-devices-bench: two parts of a device joined against one of them, on a render of 64 samples per pixel and on training steps. Both in
// turn, medians of five. A part must have its share of the machine to itself: under other load the ratio says nothing.
#include "host/phantom/phantom.hpp"
#include "host/render/session.hpp"
#include "host/train/training_step.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/trust/trust.hpp"
#include "tools/bench/statistics.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

using namespace clvr;

namespace {

void compare(const char* name, double wanted, const std::function<void()>& one, const std::function<void()>& both) {
    one(), both();
    bench::Pace pace(bench::steady_seconds);
    const bench::Timing t = bench::measure(bench::steady_seconds, pace, both, {5, 0, 600}, one);
    fmt::print("{:<28} one part {:8.0f} ms   both {:8.0f} ms   {:5.2f} x (wanted: {:.1f})\n", name, t.beside_s * 1e3, t.median_s * 1e3,
               t.ratio, wanted);
}

void render(const std::vector<Device>& parts) {
    Device first = parts.front();
    const PreparedVolume volume(make_phantom(first, "head", {Int3{88, 110, 116}}));
    Scene scene;
    scene.volume = "demo";
    scene.width = scene.height = 256;
    scene.spp = 64;
    scene.features = false;
    RenderSession one({parts.front()}, volume, scene), both(parts, volume, scene);
    compare(
        "render, 256x256, 64 spp", 1.7, [&] { clvr::render(one, scene); }, [&] { clvr::render(both, scene); });
}

void train(const std::vector<Device>& parts) {
    Model model;
    model.channels = reference_channels();
    initialise(model, 1);
    StepConfig config;
    config.batch = 16;
    config.patch = 128;
    TrainingStep one(parts.front(), model, config), both(parts, model, config);
    Frame frame;
    frame.width = frame.height = 256;
    std::uint32_t k = 1;
    for (const auto& name : reference_channels())
        for (float& v : frame.channel(name)) v = static_cast<float>((k = k * 1664525u + 1013904223u) >> 8) / (1 << 24);
    for (TrainingStep* step : {&one, &both}) step->add_image(frame, frame);
    std::vector<Crop> crops;
    for (int i = 0; i < config.batch; ++i) crops.push_back({0, 8 * i, 4 * i, i % 8});
    const auto steps = [&](TrainingStep& step) {
        for (int i = 0; i < 3; ++i) step.step(crops, 1e-4);
        step.take_losses();
    };
    compare(
        "3 steps, 16 of 128x128", 1.6, [&] { steps(one); }, [&] { steps(both); });
}

} // namespace

int main(int argc, char** argv) {
    try {
        std::vector<Device> parts;
        for (const DeviceFacts& part : select_devices(argc > 1 ? argv[1] : "cpu/2").devices) parts.push_back(open_trusted(part));
        fmt::print("{}, {} parts\n", parts.front().facts().name, parts.size());
        render(parts);
        train(parts);
        return 0;
    } catch (const Error& e) {
        fmt::print(stderr, "clvr-devices-bench: {}\n", e.line());
        return e.exit_code();
    }
}
