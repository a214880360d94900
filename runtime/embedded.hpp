// The kernel sources inside the binary.
#pragma once
#include <map>
#include <string>

namespace clvr {

/// Every file under kernels/ by its path relative to it ("render/shade.cl"). Made at build time by tools/embed.cmake.
const std::map<std::string, std::string>& embedded_kernels();

} // namespace clvr
