// The grammar of device selectors, on facts alone (no OpenCL call), so that it can be tried on any list of devices.
#pragma once
#include "runtime/drivers/facts.hpp"

#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// A position in a list of devices, whole (sub_devices 0) or divided into equal parts.
struct DevicePart {
    std::size_t device;
    int sub_devices;
};

/// Which of several devices is the fastest: positions of the candidates (at least two) in the list -> one of them.
using Fastest = std::function<std::size_t(const std::vector<std::size_t>& candidates)>;

/// Positions of the devices that clvr may take by itself: usable, and no simulators.
std::vector<std::size_t> default_candidates(const std::vector<DeviceFacts>& devices);

/// An index; `cpu` or `gpu` (the fastest of them); part of a device's or platform's name in any case; each with `/n` for n equal parts;
/// several joined by `+`; `all` is every device of default_candidates(). `where` names the option or variable that the selector comes from.
/// Throws Error{usage} for a malformed selector or a device named twice, Error{device} when nothing matches or a name matches several.
std::vector<DevicePart> resolve_selector(const std::string& selector, const std::string& where, const std::vector<DeviceFacts>& devices,
                                         const Fastest& fastest);

} // namespace clvr
