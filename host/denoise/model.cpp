#include "host/denoise/model.hpp"
#include "runtime/error.hpp"

#include <fmt/format.h>

namespace clvr {

std::vector<std::string> reference_channels() {
    return {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z"};
}

} // namespace clvr
