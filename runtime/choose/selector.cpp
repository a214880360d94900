#include "runtime/choose/selector.hpp"

#include "runtime/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

namespace clvr {
namespace {

constexpr const char* grammar = "write an index, cpu, gpu or part of a name, with /2 for two equal parts, several joined by +, or all";

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// A whole number of at most 4 digits.
std::optional<int> number(const std::string& text) {
    if (text.empty() || text.size() > 4 || !std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); }))
        return std::nullopt;
    return std::stoi(text);
}

std::string listed(const std::vector<DeviceFacts>& devices, const std::vector<std::size_t>& which) {
    std::string text;
    for (const std::size_t i : which) text += fmt::format("{}{} \"{}\"", text.empty() ? "" : ", ", devices[i].index, devices[i].name);
    return text;
}

template <class Predicate>
std::vector<std::size_t> positions(const std::vector<DeviceFacts>& devices, Predicate&& wanted) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (wanted(devices[i])) found.push_back(i);
    return found;
}

std::size_t resolve_one(const std::string& name, const std::string& where, const std::vector<DeviceFacts>& devices,
                        const Fastest& fastest) {
    const auto all = positions(devices, [](const DeviceFacts&) { return true; });
    std::vector<std::size_t> found;
    if (const auto index = number(name)) {
        found = positions(devices, [&](const DeviceFacts& d) { return d.index == *index; });
    } else if (name == "cpu" || name == "gpu") {
        const DeviceType type = name == "cpu" ? DeviceType::cpu : DeviceType::gpu;
        for (const std::size_t i : default_candidates(devices))
            if (devices[i].type == type) found.push_back(i);
        if (found.size() > 1) return fastest(found);
    } else {
        found = positions(devices, [&](const DeviceFacts& d) {
            return lower(d.name).find(name) != std::string::npos || lower(d.platform).find(name) != std::string::npos;
        });
    }
    if (found.empty())
        throw Error(ErrorKind::device, fmt::format("no device is \"{}\"; there are {} (see clvr devices)", name, listed(devices, all)),
                    where);
    if (found.size() > 1)
        throw Error(ErrorKind::device, fmt::format("\"{}\" fits several devices: {}; give the index", name, listed(devices, found)), where);
    return found.front();
}

std::vector<std::size_t> all_usable(const std::string& where, const std::vector<DeviceFacts>& devices) {
    std::vector<std::size_t> found = default_candidates(devices);
    if (found.empty())
        throw Error(ErrorKind::device, "\"all\" means usable devices that are no simulators; there is none (see clvr devices)", where);
    return found;
}

} // namespace

std::vector<std::size_t> default_candidates(const std::vector<DeviceFacts>& devices) {
    return positions(devices, [](const DeviceFacts& d) { return !d.simulator && why_unusable(d).empty(); });
}

std::vector<DevicePart> resolve_selector(const std::string& selector, const std::string& where, const std::vector<DeviceFacts>& devices,
                                         const Fastest& fastest) {
    const auto malformed = [&] {
        return Error(ErrorKind::usage, fmt::format("\"{}\" is no device selector; {}", selector, grammar), where);
    };
    std::vector<DevicePart> parts;
    for (std::size_t start = 0; start <= selector.size();) {
        const std::size_t end = std::min(selector.find('+', start), selector.size());
        std::string name = lower(selector.substr(start, end - start));
        int sub_devices = 0;
        if (const std::size_t slash = name.rfind('/'); slash != std::string::npos) {
            sub_devices = number(name.substr(slash + 1)).value_or(0);
            if (sub_devices < 2) throw malformed();
            name.erase(slash);
        }
        if (name.empty() || (name == "all" && sub_devices)) throw malformed();
        for (const std::size_t device :
             name == "all" ? all_usable(where, devices) : std::vector{resolve_one(name, where, devices, fastest)}) {
            for (const DevicePart& other : parts)
                if (other.device == device)
                    throw Error(ErrorKind::usage,
                                fmt::format("\"{}\" names device {} twice; use /2 for two equal parts of one device", selector,
                                            devices[device].index),
                                where);
            parts.push_back({device, sub_devices});
        }
        start = end + 1;
    }
    return parts;
}

} // namespace clvr
