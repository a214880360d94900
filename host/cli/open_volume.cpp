#include "host/cli/open_volume.hpp"
#include "host/phantom/phantom.hpp"
#include "runtime/schedule/scheduler.hpp"

#include <spdlog/spdlog.h>

namespace clvr {

namespace {
const std::string demo_prefix = "demo:";
}

bool is_demo_volume(const std::string& name) { return name.compare(0, demo_prefix.size(), demo_prefix) == 0; }

Voxels open_volume(const std::string& name, const VolumeReadOptions& options, std::vector<Device>& devices) {
    Voxels v = !is_demo_volume(name)
                   ? read_volume(name, options)
                   : on_first(devices, [&](Device& device) { return make_phantom(device, name.substr(demo_prefix.size())); });
    for (const auto& decision : v.decisions) spdlog::debug("{}: {}", name, decision);
    for (const auto& note : v.notes) spdlog::warn("{}: {}", name, note);
    return v;
}

} // namespace clvr
