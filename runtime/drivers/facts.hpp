// Every platform and device that OpenCL lists, with its capabilities as facts.
#pragma once
#include "runtime/drivers/opencl.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace clvr {

enum class DeviceType { cpu, gpu, accelerator };

/// What a device says about itself, read once. Sizes in bytes.
struct DeviceFacts {
    cl::Device handle;
    int index = -1;      ///< position in the list of all devices, platforms in order; what `--device N` means
    int sub_device = -1; ///< which part of a divided root device, -1 for a root device
    int sub_devices = 0; ///< into how many equal parts the root was divided (0: not divided)
    cl::Context context; ///< sub-devices share their parent's context; empty for a root device until opened
    std::string platform, platform_version, vendor, name, version, driver_version, opencl_c_version;
    DeviceType type = DeviceType::cpu;
    bool available = false, has_compiler = false;
    std::string driver_problem; ///< why its driver must not be used (runtime/drivers/driver_trial.hpp); empty: it works
    bool simulator = false;     ///< an interpreter such as Oclgrind: never chosen by default, nor by `cpu` or `gpu`
    bool pocl = false;          ///< PoCL keeps its own program cache and aborts on broken binaries
    unsigned compute_units = 0, clock_mhz = 0, native_float_width = 1, max_sub_devices = 0;
    std::size_t global_bytes = 0, max_alloc_bytes = 0, local_bytes = 0, max_work_group = 1;
    std::size_t max_work_item[3] = {1, 1, 1};
    bool unified_memory = false;
    bool claims_fma = false, claims_correct_divide_sqrt = false, claims_denormals = false;
};

struct PlatformFacts {
    std::string name, vendor, version;
    std::vector<DeviceFacts> devices; ///< may be empty: a platform without devices is a fact, too
    std::string problem = {};         ///< of its driver: none of its devices is usable
};

/// Why clvr cannot run on the device, in words; empty when it can.
std::string why_unusable(const DeviceFacts& device);

/// "cpu", "gpu" or "accelerator".
const char* type_name(DeviceType type);

/// `parts` sub-devices of equal size (where the compute units do not divide, the rest stays idle), in one context with their root.
/// Throws Error{device} when the device cannot be divided so.
std::vector<DeviceFacts> divide(const DeviceFacts& root, int parts);

/// Lists all platforms, in the loader's order; the first call tries the drivers (runtime/drivers/driver_trial.hpp). No platform at all
/// gives an empty vector. Does not throw for a broken platform: it is listed without devices, or with its problem. Throws Error{device}
/// where a driver ends the process that lists them.
std::vector<PlatformFacts> list_platforms();

/// All devices of all platforms, flat, `index` filled.
std::vector<DeviceFacts> list_devices();

} // namespace clvr
