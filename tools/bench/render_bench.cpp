// clvr-render-bench: clvr's trackers beside native scalar C++ of the same algorithms, in one run. Both sides are run in turn (a shared
// machine changes speed by the minute), warmed up, and the medians compared.
#include "host/render/marcher.hpp"
#include "host/render/params.hpp"
#include "host/render/path_tracer.hpp"
#include "runtime/select.hpp"
#include "tools/bench/native.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>

using namespace clvr;

namespace {

/// 256^3 u8: smooth blobs in a hash of a coarse lattice, about a third of it visible: shells, hollows and clear space, as a scan has.
Voxels benchmark_volume() {
    Voxels v;
    v.dims = {256, 256, 256};
    v.bytes.resize(v.count());
    const auto lattice = [](int x, int y, int z) {
        std::uint32_t h =
            static_cast<std::uint32_t>(x * 73856093) ^ static_cast<std::uint32_t>(y * 19349663) ^ static_cast<std::uint32_t>(z * 83492791);
        h = (h ^ (h >> 13)) * 0x5bd1e995u;
        return static_cast<double>((h ^ (h >> 15)) & 0xffff) / 65535;
    };
    std::size_t i = 0;
    for (int z = 0; z < 256; ++z)
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 256; ++x, ++i) {
                const double p[3] = {x / 32.0, y / 32.0, z / 32.0};
                double t[3], sum = 0;
                int c[3];
                for (int a = 0; a < 3; ++a) c[a] = static_cast<int>(p[a]), t[a] = p[a] - c[a], t[a] = t[a] * t[a] * (3 - 2 * t[a]);
                for (int k = 0; k < 8; ++k)
                    sum += lattice(c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)) * (k & 1 ? t[0] : 1 - t[0]) *
                           (k & 2 ? t[1] : 1 - t[1]) * (k & 4 ? t[2] : 1 - t[2]);
                const double dx = x - 127.5, dy = y - 127.5, dz = z - 127.5;
                v.bytes[i] = dx * dx + dy * dy + dz * dz < 120 * 120 ? static_cast<unsigned char>(sum * 255) : 0;
            }
    return v;
}

double seconds_of(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

void compare(const char* name, double rays, const std::function<void()>& clvr_side, const std::function<void()>& native_side) {
    clvr_side(), native_side();
    std::vector<double> ours, theirs;
    for (int k = 0; k < 9; ++k) ours.push_back(seconds_of(clvr_side)), theirs.push_back(seconds_of(native_side));
    const double a = median(ours), b = median(theirs);
    fmt::print("{:<28} clvr {:8.2f} ms {:7.2f} Mrays/s   native {:8.2f} ms {:7.2f} Mrays/s   {:5.2f} x\n", name, a * 1e3, rays / a * 1e-6,
               b * 1e3, rays / b * 1e-6, b / a);
}

} // namespace

int main(int argc, char** argv) {
    try {
        Device device = Device::open(select_devices(argc > 1 ? argv[1] : "").devices.front());
        Scene scene;
        scene.volume = "benchmark";
        scene.width = 640, scene.height = 368;
        scene.camera.azimuth = 25, scene.camera.elevation = 15;
        scene.transfer = TransferFunction{
            false, {{0, {0.1, 0.1, 0.1}, 0}, {140, {0.9, 0.6, 0.4}, 0}, {170, {0.9, 0.9, 0.9}, 0.6}, {255, {1, 1, 1}, 1}}, ""};

        const Voxels voxels = benchmark_volume();
        const MajorantGrid grid = majorant_grid(voxels);
        Classified c{&voxels, &grid, tabulate(*scene.transfer, voxels, 0, 255), {}};
        c.majorants = majorants(grid, c.table);
        const BrickLayout layout = device_layout(device, c);
        const shared::VolumeParams vp = volume_params(scene, voxels, grid, c.table, layout);
        const View view =
            resolve_view(scene, visible_outline(voxels.geometry, grid, c.majorants, {}, clip_box_index(scene, voxels)), false);
        const shared::RenderParams rp = render_params(scene, voxels, view, {});
        DeviceVolume volume(device, c, layout, vp);
        LightTables light(device, rp, {});
        const native::Inputs inputs{&voxels, &grid, &c.table, &c.majorants, vp, rp};
        const double rays = static_cast<double>(scene.width) * scene.height;
        fmt::print("{}, packets of {}, 256^3 u8, {}x{}\n", device.facts().name, packet_width(device), scene.width, scene.height);

        PathTracer tracer(device, volume, light, static_cast<std::uint32_t>(rays));
        std::vector<float> distance, planes(10 * static_cast<std::size_t>(rays)), native_planes;
        compare(
            "delta tracking", rays, [&] { tracer.fly_camera_rays(static_cast<std::uint32_t>(rays)); },
            [&] { native::delta_tracking(inputs, distance); });
        Marcher marcher(device, volume, light, March::features, 1);
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
