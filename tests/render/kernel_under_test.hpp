// The kernels under tests/render/kernels/: entry points that call the functions of kernels/lib directly.
#pragma once
#include "runtime/opencl/device.hpp"
#include "runtime/opencl/source.hpp"

#include <cstdlib>
#include <string>

namespace clvr::testing {

/// tests/render/kernels/<name>.cl, built over the product's kernels/lib.
inline Kernel test_kernel(Device& device, const std::string& name, const Defines& defines) {
    const char* before = std::getenv("CLVR_KERNEL_DIR");
    set_kernel_dir(CLVR_TEST_DATA "/render/kernels");
    Kernel kernel = device.kernel(name, defines);
    set_kernel_dir(before ? before : "");
    return kernel;
}

} // namespace clvr::testing
