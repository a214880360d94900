// The transfer-function presets inside the binary.
#pragma once
#include <map>
#include <string>

namespace clvr {

/// Every file of datasets/transfer_functions/ by its name ("ct-bone.json"). Made at build time by tools/embed.cmake.
const std::map<std::string, std::string>& embedded_presets();

} // namespace clvr
