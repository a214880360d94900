// `clvr devices`: what OpenCL offers here, and which device clvr will use and why.
#include "host/cli/commands.hpp"

#include "runtime/choose/select.hpp"
#include "runtime/drivers/icd.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_text.hpp"
#include "runtime/system/size.hpp"
#include "runtime/trust/trust.hpp"
#include "runtime/tune/tuning.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace clvr {
namespace {

/// Tasks that may have devices of their own (runtime/choose/remembered.hpp), and what clvr does then.
constexpr std::pair<const char*, const char*> tasks[] = {{"render", "renders"}, {"denoise", "denoises"}, {"train", "trains"}};

/// All that the command shows.
struct DevicesReport {
    std::vector<PlatformFacts> platforms;
    std::map<int, std::string> trust;           ///< by index: "ok", the failing operations, or why the device was not probed
    std::optional<Selection> selection;         ///< of the first task
    std::map<std::string, Selection> otherwise; ///< tasks for which other devices are chosen
    std::optional<Error> error;                 ///< why nothing is selected
};

bool selected(const DevicesReport& report, int index) {
    const auto in = [&](const Selection& s) {
        return std::any_of(s.devices.begin(), s.devices.end(), [&](const DeviceFacts& d) { return d.index == index; });
    };
    return (report.selection && in(*report.selection)) ||
           std::any_of(report.otherwise.begin(), report.otherwise.end(), [&](const auto& task) { return in(task.second); });
}

/// "device 0", "the 2 parts of device 0", "device 0 and device 1".
std::string selection_text(const Selection& selection) {
    std::vector<std::string> names;
    for (const DeviceFacts& device : selection.devices)
        if (device.sub_devices == 0) {
            names.push_back(fmt::format("device {}", device.index));
        } else if (device.sub_device == 0) {
            names.push_back(fmt::format("the {} parts of device {}", device.sub_devices, device.index));
        }
    return fmt::format("{}", fmt::join(names, " and "));
}

/// Simulators are slow: they are not probed merely to be listed.
std::string trust_text(const DeviceFacts& device, bool worth_probing) {
    if (const std::string why = why_unusable(device); !why.empty()) return why;
    const std::string remark = device.simulator ? " (simulator)" : "";
    try {
        const std::optional<Trust> trust = worth_probing ? trust_of(device) : stored_trust(device);
        return (trust ? trust->text() : "not probed") + remark;
    } catch (const Error& error) {
        return "cannot be probed: " + error.line();
    }
}

DevicesReport make_report(const std::string& selector) {
    DevicesReport report;
    report.platforms = list_platforms();
    try {
        report.selection = select_devices(selector, tasks[0].first);
        for (const auto& [task, does] : tasks) {
            Selection other = select_devices(selector, task);
            if (other.rule != report.selection->rule || selection_text(other) != selection_text(*report.selection))
                report.otherwise.emplace(task, std::move(other));
        }
    } catch (const Error& error) {
        report.error = error;
    }
    for (const PlatformFacts& platform : report.platforms)
        for (const DeviceFacts& device : platform.devices)
            report.trust[device.index] = trust_text(device, !device.simulator || selected(report, device.index));
    return report;
}

void print_text(const DevicesReport& report) {
    std::size_t name_width = 6, driver_width = 6;
    for (const PlatformFacts& platform : report.platforms)
        for (const DeviceFacts& device : platform.devices) {
            name_width = std::max(name_width, device.name.size());
            driver_width = std::max(driver_width, device.driver_version.size());
        }
    fmt::print("    #  {:<11}  {:<{}}  {:<{}}  {:>5}  {:>5}  {:>8}  {:>8}  {}\n", "type", "device", name_width, "driver", driver_width,
               "units", "float", "memory", "a buffer", "trust");
    for (const PlatformFacts& platform : report.platforms) {
        fmt::print("{}{}\n", platform.name,
                   !platform.devices.empty()  ? ""
                   : platform.problem.empty() ? ": no devices"
                                              : ": " + platform.problem);
        for (const DeviceFacts& d : platform.devices)
            fmt::print("  {}{:>2}  {:<11}  {:<{}}  {:<{}}  {:>5}  {:>5}  {:>8}  {:>8}  {}\n", selected(report, d.index) ? ">" : " ",
                       d.index, type_name(d.type), d.name, name_width, d.driver_version, driver_width, d.compute_units,
                       d.native_float_width, size_text(d.global_bytes), size_text(d.max_alloc_bytes), report.trust.at(d.index));
    }
    if (!report.selection) return;
    fmt::print("\n");
    if (report.otherwise.empty()) fmt::print("clvr uses {}: {}.\n", selection_text(*report.selection), report.selection->rule);
    for (const auto& [task, does] : tasks) {
        if (report.otherwise.empty()) break;
        const auto other = report.otherwise.find(task);
        const Selection& s = other == report.otherwise.end() ? *report.selection : other->second;
        fmt::print("clvr {} on {}: {}.\n", does, selection_text(s), s.rule);
    }
    for (const PlatformFacts& platform : report.platforms)
        for (const DeviceFacts& d : platform.devices)
            if (selected(report, d.index)) fmt::print("Tuning of device {}: {}.\n", d.index, tuning_in_force(d).rule);
}

nlohmann::json to_json(const DeviceFacts& d, const std::string& trust) {
    const TuningInForce tuning = tuning_in_force(d);
    return {{"index", d.index},
            {"name", d.name},
            {"vendor", d.vendor},
            {"type", type_name(d.type)},
            {"version", d.version},
            {"driver_version", d.driver_version},
            {"opencl_c_version", d.opencl_c_version},
            {"unusable", why_unusable(d)},
            {"simulator", d.simulator},
            {"compute_units", d.compute_units},
            {"clock_mhz", d.clock_mhz},
            {"native_float_width", d.native_float_width},
            {"max_sub_devices", d.max_sub_devices},
            {"global_bytes", d.global_bytes},
            {"max_alloc_bytes", d.max_alloc_bytes},
            {"local_bytes", d.local_bytes},
            {"max_work_group", d.max_work_group},
            {"max_work_item", d.max_work_item},
            {"unified_memory", d.unified_memory},
            {"claims_fma", d.claims_fma},
            {"claims_correct_divide_sqrt", d.claims_correct_divide_sqrt},
            {"claims_denormals", d.claims_denormals},
            {"tuning", {{"rule", tuning.rule}, {"values", tuning.values}}},
            {"trust", trust}};
}

nlohmann::json to_json(const Selection& selection) {
    nlohmann::json devices = nlohmann::json::array();
    for (const DeviceFacts& d : selection.devices) {
        nlohmann::json device{{"index", d.index}, {"name", d.name}, {"compute_units", d.compute_units}};
        if (d.sub_devices) device.update({{"sub_device", d.sub_device}, {"sub_devices", d.sub_devices}});
        devices.push_back(device);
    }
    return {{"devices", devices}, {"rule", selection.rule}};
}

void print_json(const DevicesReport& report) {
    nlohmann::json platforms = nlohmann::json::array();
    for (const PlatformFacts& platform : report.platforms) {
        nlohmann::json devices = nlohmann::json::array();
        for (const DeviceFacts& device : platform.devices) devices.push_back(to_json(device, report.trust.at(device.index)));
        platforms.push_back({{"name", platform.name}, {"vendor", platform.vendor}, {"version", platform.version}, {"devices", devices}});
    }
    nlohmann::json selection;
    if (report.selection) selection = to_json(*report.selection);
    for (const auto& [task, other] : report.otherwise) selection["tasks"][task] = to_json(other);
    fmt::print("{}", json_text(nlohmann::json{{"platforms", platforms}, {"selection", selection}}));
}

struct DevicesOptions {
    std::string selector;
    bool json = false;
};

void devices_command(const DevicesOptions& options) {
    for (const std::string& driver : unloadable_drivers()) spdlog::warn("an OpenCL driver is missing: {}", driver);
    const DevicesReport report = make_report(options.selector);
    if (options.json)
        print_json(report);
    else if (!report.platforms.empty())
        print_text(report);
    std::fflush(stdout); // before the error, should both go to one terminal
    if (report.error) throw Error(*report.error);
}

} // namespace

void add_devices_command(CLI::App& app) {
    const auto options = std::make_shared<DevicesOptions>();
    CLI::App* command = app.add_subcommand("devices", "What OpenCL offers here, and which device clvr will use and why");
    command
        ->add_option("--device", options->selector,
                     "Show what this selector chooses: an index, cpu, gpu, part of a name, cpu/2, several joined by +, or all")
        ->type_name("SEL")
        ->group("Device");
    command->add_flag("--json", options->json, "Print JSON")->group("Output");
    command->footer("Examples:\n"
                    "  clvr devices\n"
                    "  clvr devices --device gpu+cpu\n");
    command->callback([options] { devices_command(*options); });
}

} // namespace clvr
