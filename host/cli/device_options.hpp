// The options that choose and limit devices: the same for every command that computes.
#pragma once
#include "runtime/opencl/device.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace clvr {

struct DeviceOptions {
    std::string selector, memory;
    std::string task; ///< "render", "denoise" or "train": which remembered choice counts (runtime/choose/remembered.hpp)
    bool relaxed = false, profile = false;
};

/// Adds --device, --memory, --relaxed and --profile for a command of that task.
void add_device_options(CLI::App& command, DeviceOptions& options, const std::string& task);

/// Opens what the options select, with its memory limit: all of them (of several, one that cannot be opened is left out with a warning), or
/// the first alone. Throws Error.
std::vector<Device> open_devices(const DeviceOptions& options);
Device open_device(const DeviceOptions& options);

/// Prints each device's table to stderr where --profile asks for it.
void print_profiles(const DeviceOptions& options, std::vector<Device> devices);

} // namespace clvr
