#include "host/cli/device_options.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/schedule/scheduler.hpp"
#include "runtime/system/size.hpp"
#include "runtime/trust/trust.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clvr {

void add_device_options(CLI::App& c, DeviceOptions& o, const std::string& task) {
    o.task = task;
    c.add_option("--device", o.selector,
                 "An index, cpu, gpu, part of a name, cpu/2, several joined by +, or all [what `clvr devices` says]")
        ->type_name("SEL")
        ->group("Device");
    c.add_option("--memory", o.memory, "Use at most so much device memory")->type_name("SIZE")->group("Device");
    c.add_flag("--relaxed", o.relaxed, "Use a device that fails the trust probe; its bits may differ")->group("Device");
    c.add_flag("--profile", o.profile, "Print where the time went, a line a stage")->group("Device");
}

std::vector<Device> open_devices(const DeviceOptions& o) {
    const Selection selection = select_devices(o.selector, o.task);
    std::vector<Device> devices;
    std::size_t refused = 0;
    for (const auto& facts : selection.devices) {
        try {
            devices.push_back(open_trusted(facts, o.relaxed));
        } catch (const Error& error) { // left out, as a device that fails later is, while there are others
            if (!is_device_failure(error) || ++refused == selection.devices.size()) throw;
            spdlog::warn("{} is left out: {}", display_name(facts), error.line().substr(0, error.line().find('\n')));
            continue;
        }
        if (!o.memory.empty()) devices.back().set_memory_limit(parse_size(o.memory, "--memory"));
        spdlog::debug("device {}: {} ({})", facts.index, facts.name, selection.rule);
    }
    return devices;
}

Device open_device(const DeviceOptions& options) { return open_devices(options).front(); }

void print_profiles(const DeviceOptions& options, std::vector<Device> devices) {
    if (!options.profile) return;
    for (auto& d : devices) {
        d.finish();
        std::fputs(d.profile().table().c_str(), stderr);
    }
}

} // namespace clvr
