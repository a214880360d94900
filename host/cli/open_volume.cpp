#include "host/cli/open_volume.hpp"
#include "host/volume/phantom.hpp"

#include <spdlog/spdlog.h>

namespace clvr {

namespace {
const std::string demo_prefix = "demo:";
}

bool is_demo_volume(const std::string& name) { return name.compare(0, demo_prefix.size(), demo_prefix) == 0; }

Voxels open_volume(const std::string& name, const VolumeReadOptions& options, Device& device) {
    Voxels v = is_demo_volume(name) ? make_phantom(device, name.substr(demo_prefix.size())) : read_volume(name, options);
    for (const auto& decision : v.decisions) spdlog::debug("{}: {}", name, decision);
    for (const auto& note : v.notes) spdlog::warn("{}: {}", name, note);
    return v;
}

} // namespace clvr
