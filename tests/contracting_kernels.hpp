// The kernels as a compiler sees them that may contract a * b + c.
#pragma once
#include "runtime/system/embedded.hpp"

#include <map>
#include <string>

namespace clvr {

/// Every embedded kernel file with contraction allowed, but for the trust probe, which finds out what the compiler does. `allowed` counts
/// the places.
inline std::map<std::string, std::string> contracting_kernels(int& allowed) {
    std::map<std::string, std::string> files = embedded_kernels();
    const std::string off = "FP_CONTRACT OFF";
    allowed = 0;
    for (auto& [path, text] : files)
        if (path.rfind("probe/", 0) != 0)
            for (std::size_t at; (at = text.find(off)) != std::string::npos; ++allowed) text.replace(at, off.size(), "FP_CONTRACT ON");
    return files;
}

} // namespace clvr
