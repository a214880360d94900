#include "runtime/select.hpp"

#include "runtime/error.hpp"

#include <algorithm>

namespace clvr {

Selection select_devices(const std::string& selector) {
    for (const DeviceFacts& device : list_devices())
        if (device.available && !device.simulator && (selector.empty() || device.name.find(selector) != std::string::npos))
            return {{device}, "the first device"};
    throw Error(ErrorKind::device, "no OpenCL device; install pocl-opencl-icd");
}

} // namespace clvr
