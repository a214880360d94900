// clvr-render-bench: clvr's trackers beside native scalar C++ of the same algorithms, in one run, each side in turn.
#include "host/render/marcher.hpp"
#include "host/render/path_tracer.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/trust/trust.hpp"
#include "tools/bench/bench_scene.hpp"
#include "tools/bench/native.hpp"
#include "tools/bench/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

using namespace clvr;

namespace {

void compare(const char* name, double rays, const std::function<void()>& clvr_side, const std::function<void()>& native_side) {
    clvr_side(), native_side();
    bench::Pace pace(bench::steady_seconds);
    const bench::Timing t = bench::measure(bench::steady_seconds, pace, clvr_side, {9, 0, 60}, native_side);
    fmt::print("{:<28} clvr {:8.2f} ms {:7.2f} Mrays/s   native {:8.2f} ms {:7.2f} Mrays/s   {:5.2f} x\n", name, t.median_s * 1e3,
               rays / t.median_s * 1e-6, t.beside_s * 1e3, rays / t.beside_s * 1e-6, t.ratio);
}

} // namespace

int main(int argc, char** argv) {
    try {
        Device device = open_trusted(select_devices(argc > 1 ? argv[1] : "").devices.front());
        const Scene scene = bench::benchmark_scene(640, 368, 1);
        const PreparedVolume& prepared = bench::prepared_volume(256);
        const bench::SceneOnDevice parts(device, prepared, scene);
        const native::Inputs inputs{&prepared.voxels,    &prepared.grid,     &parts.classified.table, &parts.classified.majorants,
                                    parts.volume_params, parts.render_params};
        const double rays = static_cast<double>(scene.width) * scene.height;
        fmt::print("{}, packets of {}, 256^3 u8, {}x{}\n", device.facts().name, packet_width(device), scene.width, scene.height);

        PathTracer tracer(device, *parts.volume, *parts.light, parts.pixels);
        std::vector<float> distance, planes(march_planes(March::features) * static_cast<std::size_t>(rays)), native_planes;
        compare(
            "delta tracking", rays, [&] { tracer.fly_camera_rays(static_cast<std::uint32_t>(rays)); },
            [&] { native::delta_tracking(inputs, distance); });
        Marcher marcher(device, *parts.volume, *parts.light, *parts.keys, *parts.sky, 1);
        compare(
            "feature march", rays, [&] { marcher.run(0, static_cast<std::uint32_t>(rays), planes, static_cast<std::size_t>(rays), 0); },
            [&] { native::feature_march(inputs, native_planes); });
        double ours = 0, theirs = 0;
        for (std::size_t k = 0; k < rays; ++k) ours += planes[7 * rays + k], theirs += native_planes[7 * rays + k];
        fmt::print("mean opacity: clvr {:.6f}, native {:.6f}; native hits {:.6f}\n", ours / rays, theirs / rays,
                   std::count_if(distance.begin(), distance.end(), [](float d) { return d >= 0; }) / rays);
        return 0;
    } catch (const Error& e) {
        fmt::print(stderr, "clvr-render-bench: {}\n", e.line());
        return e.exit_code();
    }
}
