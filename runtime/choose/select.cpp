#include "runtime/choose/select.hpp"

#include "runtime/choose/speed.hpp"
#include "runtime/drivers/icd.hpp"
#include "runtime/error.hpp"
#include "runtime/tune/tuning.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

namespace clvr {
namespace {

constexpr const char* advice = "install a driver for your GPU, or PoCL for the CPU (Debian: apt install pocl-opencl-icd)";

std::vector<DeviceFacts> flat(const std::vector<PlatformFacts>& platforms) {
    std::vector<DeviceFacts> devices;
    for (const PlatformFacts& platform : platforms) devices.insert(devices.end(), platform.devices.begin(), platform.devices.end());
    return devices;
}

/// `skipped`: what is wrong with drivers that the loader left out.
[[noreturn]] void refuse_without_platform(const std::vector<std::string>& skipped) {
    const std::string why = skipped.empty() ? "" : fmt::format(" ({})", fmt::join(skipped, "; "));
    throw Error(ErrorKind::device, fmt::format("there is no OpenCL platform on this machine{}; {}", why, advice));
}

void require_devices(const std::vector<PlatformFacts>& platforms) {
    if (platforms.empty()) refuse_without_platform({});
    std::string names;
    for (const PlatformFacts& platform : platforms) {
        if (!platform.devices.empty()) return;
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", platform.name);
    }
    throw Error(ErrorKind::device, fmt::format("no OpenCL platform here has a device ({}); {}", names, advice));
}

/// The choice where nobody asked for a device.
Choice by_default(const std::vector<DeviceFacts>& devices, const Fastest& fastest) {
    const std::vector<std::size_t> candidates = default_candidates(devices);
    if (candidates.empty()) {
        for (const DeviceFacts& device : devices) // a driver that can be repaired is the better advice
            if (!device.driver_problem.empty()) throw Error(ErrorKind::device, device.driver_problem, device.name);
        throw Error(
            ErrorKind::device,
            fmt::format("there are only simulators or unusable devices here (see clvr devices); choose one with --device, or {}", advice));
    }
    if (candidates.size() == 1) return {{{candidates[0], 0}}, "it is the only usable device that is no simulator"};
    return {{{fastest(candidates), 0}}, fmt::format("it was the fastest of {} in clvr's short probe", candidates.size())};
}

} // namespace

Choice choose_devices(const std::vector<PlatformFacts>& platforms, const Wishes& wishes, const Fastest& fastest) {
    require_devices(platforms);
    const std::vector<DeviceFacts> devices = flat(platforms);
    if (!wishes.option.empty())
        return {resolve_selector(wishes.option, "--device", devices, fastest), fmt::format("--device {} says so", wishes.option)};
    if (!wishes.environment.empty())
        return {resolve_selector(wishes.environment, "CLVR_DEVICE", devices, fastest),
                fmt::format("the environment's CLVR_DEVICE={} says so", wishes.environment)};
    if (!wishes.remembered) return by_default(devices, fastest);
    if (const auto parts = recall(*wishes.remembered, devices)) return {*parts, "clvr-bench --save remembered it"};
    std::string names;
    for (const RememberedDevice& device : *wishes.remembered) names += fmt::format("{}\"{}\"", names.empty() ? "" : " + ", device.name);
    Choice choice = by_default(devices, fastest);
    choice.rule += fmt::format(" (the remembered {} is gone)", names);
    return choice;
}

Selection select_devices(const std::string& selector, const std::string& task) {
    tunables_from_environment(); // what it refuses is said before devices are tried
    const char* environment = std::getenv("CLVR_DEVICE");
    const std::vector<PlatformFacts> platforms = list_platforms();
    if (platforms.empty()) refuse_without_platform(unloadable_drivers());
    const std::vector<DeviceFacts> devices = flat(platforms);
    const bool asked = !selector.empty() || (environment && *environment);
    const Wishes wishes{selector, environment ? environment : "", asked ? std::nullopt : load_remembered(task)};
    const Choice choice =
        choose_devices(platforms, wishes, [&](const std::vector<std::size_t>& candidates) { return fastest_device(devices, candidates); });
    Selection selection{{}, choice.rule};
    for (const DevicePart& part : choice.parts) {
        const DeviceFacts& device = devices[part.device];
        const auto parts = part.sub_devices ? divide(device, part.sub_devices) : std::vector{device};
        selection.devices.insert(selection.devices.end(), parts.begin(), parts.end());
    }
    spdlog::debug("device {}: {}", selection.devices.front().name, selection.rule);
    return selection;
}

} // namespace clvr
