// The manifests inside the binary.
#pragma once
#include <map>
#include <string>

namespace clvr {

/// Every file of datasets/manifests/ by its name ("stag_beetle.json"). Made at build time by tools/embed.cmake.
const std::map<std::string, std::string>& embedded_manifests();

} // namespace clvr
