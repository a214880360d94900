#include "runtime/choose/speed.hpp"
#include "runtime/trust/trust.hpp"

#include "runtime/opencl/device.hpp"
#include "runtime/opencl/fault.hpp"
#include "runtime/system/folders.hpp"
#include "runtime/system/hashes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>

namespace clvr {
namespace {

constexpr const char* speed_version = "speed 1"; // of the probe and of the stored form

std::filesystem::path speed_path(const std::filesystem::path& folder, const std::string& key) {
    return folder / "fastest" / (key + ".json");
}

} // namespace

double probe_speed_ms(const DeviceFacts& facts) {
    constexpr cl_uint lanes = 1u << 18, entries = 1u << 20, steps = 32;
    constexpr int repetitions = 4; // the first one warms up
    const ProbeScope probing;
    Device device = open_trusted(facts);
    std::vector<cl_uint> table(entries);
    std::iota(table.begin(), table.end(), 12345u);
    const Buffer entries_buffer = device.upload(table, "speed table");
    const Buffer results = device.buffer(lanes * sizeof(float), "speed results");
    double best_ms = std::numeric_limits<double>::infinity();
    for (const cl_uint width : {1u, 16u}) {
        Kernel kernel = device.kernel("probe/speed", {{"CLVR_WIDTH", std::to_string(width)}});
        const Range local{std::min<std::size_t>(64, kernel.max_local_items())};
        for (int i = 0; i < repetitions; ++i) {
            device.finish();
            const auto start = std::chrono::steady_clock::now(); // rusticl 22.3 says 1 ns in its profiling events
            device.launch(kernel, {lanes / width}, local, {}, results, entries_buffer, entries - 1, steps, lanes / width);
            device.finish();
            if (i > 0)
                best_ms = std::min(best_ms, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        }
    }
    return best_ms;
}

std::size_t fastest_device(const std::vector<DeviceFacts>& devices, const std::vector<std::size_t>& candidates) {
    std::string list = speed_version;
    for (const std::size_t i : candidates)
        list += fmt::format("\n{}|{}|{}|{}", devices[i].platform, devices[i].platform_version, devices[i].name, devices[i].driver_version);
    const auto folder = cache_folder();
    const auto path = folder ? std::optional(speed_path(*folder, sha256_hex(list))) : std::nullopt;
    if (const auto text = path ? load_file(*path) : std::nullopt) {
        const auto json = nlohmann::json::parse(*text, nullptr, false);
        const auto fastest = json.is_object() && json.contains("fastest") && json["fastest"].is_number_unsigned()
                                 ? json["fastest"].get<std::size_t>()
                                 : candidates.size();
        if (fastest < candidates.size()) return candidates[fastest];
    }
    std::size_t fastest = candidates.size();
    double best_ms = std::numeric_limits<double>::infinity();
    std::string refused;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const DeviceFacts& device = devices[candidates[k]];
        try {
            const double ms = probe_speed_ms(device);
            spdlog::debug("speed probe: {:.2f} ms on {} \"{}\"", ms, device.index, device.name);
            if (ms < best_ms) {
                best_ms = ms;
                fastest = k;
            }
        } catch (const Error& error) {
            spdlog::warn("not considered: {}", error.line());
            refused += (refused.empty() ? "" : "; ") + error.line();
        }
    }
    if (fastest == candidates.size()) throw Error(ErrorKind::device, "no device runs clvr's probe: " + refused);
    if (path) replace_file(*path, nlohmann::json{{"devices", list}, {"fastest", fastest}, {"ms", best_ms}}.dump(2) + "\n");
    return candidates[fastest];
}

} // namespace clvr
