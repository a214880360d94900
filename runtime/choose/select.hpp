// Which device to use, and why (runtime/README.md, "Device selector").
#pragma once
#include "runtime/choose/remembered.hpp"
#include "runtime/choose/selector.hpp"
#include "runtime/drivers/facts.hpp"

#include <optional>
#include <string>
#include <vector>

namespace clvr {

struct Selection {
    std::vector<DeviceFacts> devices; ///< one or more; sub-devices share their parent's context
    std::string rule;                 ///< one sentence: which rule decided
};

/// What may decide, in this order; the fastest by a short probe comes last.
struct Wishes {
    std::string option;      ///< --device
    std::string environment; ///< CLVR_DEVICE
    std::optional<std::vector<RememberedDevice>> remembered;
};

struct Choice {
    std::vector<DevicePart> parts; ///< positions in the flat list of all devices
    std::string rule;
};

/// The choice among these platforms' devices, without any OpenCL call but those of `fastest`.
/// Throws Error{device} when there is no platform, no device, or none that the deciding rule allows; Error{usage} for a malformed selector.
Choice choose_devices(const std::vector<PlatformFacts>& platforms, const Wishes& wishes, const Fastest& fastest);

/// Resolves the selector: `selector` if not empty, else CLVR_DEVICE, else what was remembered, else the fastest by a short probe whose
/// answer is stored per device list and driver version. A selector is an index, `cpu`, `gpu`, part of a name, `cpu/2`, several joined by
/// `+`, or `all`. `task`, such as "render", asks for what was remembered for it. Throws Error{device} when nothing matches or a name
/// matches several (the message lists them), or when there is no platform or no device.
Selection select_devices(const std::string& selector = {}, const std::string& task = {});

} // namespace clvr
