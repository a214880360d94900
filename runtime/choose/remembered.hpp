// The choice of devices that `clvr-bench --save` keeps for the next runs: $XDG_CONFIG_HOME/clvr/device.json.
#pragma once
#include "runtime/choose/selector.hpp"
#include "runtime/drivers/facts.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// A device by name, as indices change when drivers come and go.
struct RememberedDevice {
    std::string platform, name;
    int occurrence = 0;  ///< which of several devices of the same names, in the order of the list
    int sub_devices = 0; ///< equal parts, 0: whole
};

/// Devices by task, such as "render".
using RememberedByTask = std::map<std::string, std::vector<RememberedDevice>>;

/// What is kept for the task, else for all; nothing when there is no such file, or, with a warning, none that can be understood.
std::optional<std::vector<RememberedDevice>> load_remembered(const std::string& task = {});

/// Keeps the choice for all tasks but those of `by_task`. Throws Error{input} naming the file when it cannot be written.
void save_remembered(const std::vector<RememberedDevice>& devices, const RememberedByTask& by_task = {});

/// How to remember these parts of the list.
std::vector<RememberedDevice> remember(const std::vector<DevicePart>& parts, const std::vector<DeviceFacts>& devices);

/// The remembered devices in this list; nothing when one of them is gone, or cannot be divided so.
std::optional<std::vector<DevicePart>> recall(const std::vector<RememberedDevice>& remembered, const std::vector<DeviceFacts>& devices);

} // namespace clvr
