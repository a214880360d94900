#include "host/cli/commands.hpp"

#include "runtime/facts.hpp"

#include <fmt/format.h>

namespace clvr {

void add_devices_command(CLI::App& app) {
    app.add_subcommand("devices", "What OpenCL offers here, and which device clvr will use and why")->callback([] {
        for (const DeviceFacts& device : list_devices()) fmt::print("{}  {}\n", device.index, device.name);
    });
}

} // namespace clvr
