#include "host/cli/provenance.hpp"
#include "runtime/system/embedded.hpp"
#include "runtime/system/hashes.hpp"

namespace clvr {

namespace {

/// One value that changes with any kernel file.
std::string kernels_sha256() {
    std::string all;
    for (const auto& [path, text] : embedded_kernels()) all += path + '\n' + text;
    return sha256_hex(all);
}

} // namespace

void add_provenance(Frame& frame, const Scene& scene, const std::string& scene_text, const std::vector<Device>& devices) {
    std::string names;
    for (const Device& d : devices)
        names += (names.empty() ? "" : " + ") + d.facts().name + " (" + d.facts().platform + " " + d.facts().driver_version + ")";
    frame.attributes["clvr.version"] = CLVR_VERSION;
    frame.attributes["clvr.volume.sha256"] = scene.volume_sha256;
    frame.attributes["clvr.scene"] = scene_text;
    frame.attributes["clvr.seed"] = std::to_string(scene.seed);
    frame.attributes["clvr.device"] = names;
    frame.attributes["clvr.kernels.sha256"] = kernels_sha256();
}

} // namespace clvr
