#include "runtime/choose/remembered.hpp"
#include "runtime/system/json_text.hpp"

#include "runtime/error.hpp"
#include "runtime/system/folders.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace clvr {
namespace {

std::optional<std::filesystem::path> remembered_path() {
    const auto folder = config_folder();
    if (!folder) return std::nullopt;
    return *folder / "device.json";
}

nlohmann::json entries_of(const std::vector<RememberedDevice>& devices) {
    nlohmann::json entries = nlohmann::json::array();
    for (const RememberedDevice& device : devices)
        entries.push_back(
            {{"platform", device.platform}, {"name", device.name}, {"occurrence", device.occurrence}, {"sub_devices", device.sub_devices}});
    return entries;
}

/// A member that counts, 0 where it is absent; nothing when it is no whole number from 0 to 2^20.
std::optional<int> count_of(const nlohmann::json& entry, const char* name) {
    if (!entry.contains(name)) return 0;
    const nlohmann::json& value = entry.at(name);
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 1u << 20) return std::nullopt;
    return value.get<int>();
}

bool same_names(const DeviceFacts& a, const DeviceFacts& b) { return a.platform == b.platform && a.name == b.name; }

} // namespace

std::optional<std::vector<RememberedDevice>> load_remembered(const std::string& task) {
    const auto path = remembered_path();
    const auto text = path ? load_file(*path) : std::nullopt;
    if (!text) return std::nullopt;
    std::vector<RememberedDevice> devices;
    const auto ignored = [&](const char* why) {
        warn_of_ignored_file({ErrorKind::input, why, path->string()});
        return std::nullopt;
    };
    constexpr const char* no_list = "is not a list of devices as clvr-bench --save writes it; delete the file or run clvr-bench --save";
    try {
        const auto json = nlohmann::json::parse(*text);
        const bool by_task = json.contains("tasks") && json.at("tasks").contains(task);
        for (const nlohmann::json& entry : by_task ? json.at("tasks").at(task) : json.at("devices")) {
            const auto occurrence = count_of(entry, "occurrence"), sub_devices = count_of(entry, "sub_devices");
            if (!occurrence || !sub_devices) return ignored(no_list);
            devices.push_back({entry.at("platform"), entry.at("name"), *occurrence, *sub_devices});
        }
    } catch (const nlohmann::json::exception&) {
        return ignored(no_list);
    }
    if (devices.empty()) return ignored("names no device; delete the file or run clvr-bench --save");
    return devices;
}

void save_remembered(const std::vector<RememberedDevice>& devices, const RememberedByTask& by_task) {
    const auto path = remembered_path();
    if (!path) throw Error(ErrorKind::input, "there is no folder to remember the device in; set HOME or XDG_CONFIG_HOME");
    nlohmann::json json{{"devices", entries_of(devices)}};
    for (const auto& [task, chosen] : by_task) json["tasks"][task] = entries_of(chosen);
    if (!replace_file(*path, json_text(json)))
        throw Error(ErrorKind::input, "cannot be written; check the folder's permissions", path->string());
}

std::vector<RememberedDevice> remember(const std::vector<DevicePart>& parts, const std::vector<DeviceFacts>& devices) {
    std::vector<RememberedDevice> remembered;
    for (const DevicePart& part : parts) {
        const DeviceFacts& device = devices[part.device];
        const auto before = std::count_if(devices.begin(), devices.begin() + static_cast<std::ptrdiff_t>(part.device),
                                          [&](const DeviceFacts& d) { return same_names(d, device); });
        remembered.push_back({device.platform, device.name, static_cast<int>(before), part.sub_devices});
    }
    return remembered;
}

std::optional<std::vector<DevicePart>> recall(const std::vector<RememberedDevice>& remembered, const std::vector<DeviceFacts>& devices) {
    std::vector<DevicePart> parts;
    for (const RememberedDevice& wanted : remembered) {
        int occurrence = wanted.occurrence;
        const auto found = std::find_if(devices.begin(), devices.end(), [&](const DeviceFacts& d) {
            return d.platform == wanted.platform && d.name == wanted.name && occurrence-- == 0;
        });
        if (found == devices.end()) return std::nullopt;
        if (wanted.sub_devices == 1 || static_cast<unsigned>(wanted.sub_devices) > found->max_sub_devices) return std::nullopt;
        parts.push_back({static_cast<std::size_t>(found - devices.begin()), wanted.sub_devices});
    }
    return parts;
}

} // namespace clvr
