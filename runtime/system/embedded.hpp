// Files inside the binary, made at build time by tools/embed.cmake.
#pragma once
#include <map>
#include <string>

namespace clvr {

/// Every file under kernels/ by its path relative to it ("render/shade.cl").
const std::map<std::string, std::string>& embedded_kernels();

/// Every file under datasets/tuning/ by its name.
const std::map<std::string, std::string>& embedded_tuning();

} // namespace clvr
