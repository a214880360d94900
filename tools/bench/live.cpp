#include "tools/bench/live.hpp"
#include "host/denoise/channels.hpp"
#include "host/denoise/denoiser.hpp"
#include "tools/bench/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>

namespace clvr::bench {
namespace {

double total_ms(const std::vector<ProfileRow>& rows) {
    double sum = 0;
    for (const ProfileRow& row : rows) sum += row.elapsed_ms;
    return sum;
}

/// Frames of one kind until the time is up.
LiveRow measure_frames(Device& device, const std::string& what, const Scene& scene, double seconds, const std::function<void()>& frame) {
    using clock = std::chrono::steady_clock;
    for (int k = 0; k < 2; ++k) frame();
    device.finish();
    device.profile().clear();
    LiveRow row{what, scene.width, scene.height, 0, 0, 0, {}};
    std::vector<double> wall, on_device;
    double before = 0;
    for (const auto begin = clock::now(); row.frames < 3 || std::chrono::duration<double>(clock::now() - begin).count() < seconds;
         ++row.frames) {
        const auto start = clock::now();
        frame();
        wall.push_back(std::chrono::duration<double, std::milli>(clock::now() - start).count());
        device.finish();
        const double now = total_ms(device.profile().rows());
        on_device.push_back(now - std::exchange(before, now));
    }
    row.frame_ms = median(wall), row.device_ms = median(on_device);
    row.stages = device.profile().rows();
    for (ProfileRow& stage : row.stages) stage.elapsed_ms /= row.frames, stage.launches /= static_cast<std::size_t>(row.frames);
    std::sort(row.stages.begin(), row.stages.end(), [](const ProfileRow& a, const ProfileRow& b) { return a.elapsed_ms > b.elapsed_ms; });
    return row;
}

} // namespace

std::vector<LiveRow> measure_live(Device& device, const PreparedVolume& volume, const Scene& first, const Model& model, double seconds) {
    Scene scene = first;
    RenderSession session({device}, volume, scene);
    Denoiser denoiser(device, model);
    RenderControl control;
    control.light = reads_light(model);
    const auto finish = [&] {
        if (Film* const film = session.film()) denoiser.denoise(*film);
        session.picture(scene.background, {scene.tonemap, scene.exposure}, true);
    };
    const auto moved = [&] {
        control.draft = true;
        session.march_features(1, control);
        control.draft = false;
        session.accumulate(1, control);
        finish();
    };
    std::vector<LiveRow> rows;
    for (const auto& [width, height] : {std::pair{240, 168}, {320, 320}, {640, 640}}) {
        scene.width = width, scene.height = height;
        session.set_size(width, height);
        rows.push_back(measure_frames(device, "moving", scene, seconds, [&] {
            scene.camera.azimuth += 3;
            session.set_view(scene);
            moved();
        }));
    }
    scene.width = scene.height = 320;
    session.set_size(320, 320);
    if (!scene.transfer) scene.transfer = automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels));
    rows.push_back(measure_frames(device, "transfer function", scene, seconds, [&, step = 0]() mutable {
        scene.transfer->points.back().color[0] = ++step % 2 ? 0.8 : 0.9;
        session.set_appearance(scene);
        moved();
    }));
    scene.width = scene.height = 640;
    session.set_size(640, 640);
    rows.push_back(measure_frames(device, "first of settled", scene, seconds, [&] {
        scene.camera.azimuth += 3;
        session.set_view(scene);
        session.march_features(4, control);
        session.accumulate(1, control);
        finish();
    }));
    rows.push_back(measure_frames(device, "settled", scene, seconds, [&] {
        session.march_features(4, control);
        session.accumulate(1, control);
        finish();
    }));
    return rows;
}

std::string live_table(const std::vector<LiveRow>& rows) {
    std::string text = fmt::format("{:<18} {:>9} {:>9} {:>9} {:>10} {:>7}\n", "live", "size", "frames/s", "frame ms", "device ms", "host");
    for (const LiveRow& r : rows)
        text += fmt::format("{:<18} {:>9} {:>9.2f} {:>9.1f} {:>10.1f} {:>6.1f}%\n", r.what, fmt::format("{}x{}", r.width, r.height),
                            1000 / r.frame_ms, r.frame_ms, r.device_ms, 100 * (r.frame_ms - r.device_ms) / r.frame_ms);
    for (const LiveRow& r : rows) {
        text += fmt::format("{} {}x{}:", r.what, r.width, r.height);
        for (const ProfileRow& stage : r.stages)
            if (stage.elapsed_ms >= 0.01 * r.frame_ms)
                text += fmt::format(" {} {:.1f}{}", stage.label, stage.elapsed_ms,
                                    stage.launches > 1 ? fmt::format(" ({})", stage.launches) : "");
        text += '\n';
    }
    return text;
}

} // namespace clvr::bench
