// The models inside the binary.
#pragma once
#include <map>
#include <string>

namespace clvr {

/// Every file of datasets/models/ that ends in .safetensors, by its name ("default.safetensors"). Made at build time by tools/embed.cmake.
const std::map<std::string, std::string>& embedded_models();

} // namespace clvr
