#include "runtime/drivers/facts.hpp"

#include "runtime/drivers/check.hpp"
#include "runtime/drivers/driver_trial.hpp"
#include "runtime/drivers/quirks.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

namespace clvr {
namespace {

/// Drivers pad their texts with blanks and a terminating zero.
std::string trimmed(std::string text) {
    const char* blank = " \t\n\r";
    text.erase(std::min(text.find('\0'), text.size()));
    text.erase(text.find_last_not_of(blank) + 1);
    text.erase(0, std::min(text.find_first_not_of(blank), text.size()));
    return text;
}

/// "OpenCL <major>.<minor> ..." of at least 1.2.
bool offers_1_2(const std::string& version) {
    int major = 0, minor = 0;
    return std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor) == 2 && major * 10 + minor >= 12;
}

/// The facts that the device itself tells.
DeviceFacts facts_of(const cl::Device& device, const std::string& platform, const std::string& platform_version) {
    DeviceFacts f;
    f.handle = device;
    f.platform = platform;
    f.platform_version = platform_version;
    f.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    f.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    f.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    f.driver_version = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    f.opencl_c_version = trimmed(device.getInfo<CL_DEVICE_OPENCL_C_VERSION>());
    f.simulator = quirks::oclgrind_claims_every_device_type(f.platform);
    f.pocl = quirks::pocl_aborts_on_broken_binaries(f.platform);
    const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
    f.type = f.simulator || (type & CL_DEVICE_TYPE_CPU) ? DeviceType::cpu
             : type & CL_DEVICE_TYPE_GPU                ? DeviceType::gpu
                                                        : DeviceType::accelerator;
    f.available = device.getInfo<CL_DEVICE_AVAILABLE>();
    f.has_compiler = device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>();
    f.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    f.clock_mhz = device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>();
    f.native_float_width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    f.global_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    f.max_alloc_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    f.local_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    f.max_work_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    const auto items = device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>();
    std::copy_n(items.begin(), std::min<std::size_t>(items.size(), 3), f.max_work_item);
    cl_bool unified = CL_FALSE; // deprecated since 2.0, but the only question that 1.2 has for it
    clGetDeviceInfo(device(), CL_DEVICE_HOST_UNIFIED_MEMORY, sizeof unified, &unified, nullptr);
    f.unified_memory = unified == CL_TRUE;
    const cl_device_fp_config config = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
    f.claims_fma = config & CL_FP_FMA;
    f.claims_correct_divide_sqrt = config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    f.claims_denormals = config & CL_FP_DENORM;
    if (offers_1_2(f.version)) { // older devices do not know the question
        const auto partitions = device.getInfo<CL_DEVICE_PARTITION_PROPERTIES>();
        const bool equally = std::find(partitions.begin(), partitions.end(), CL_DEVICE_PARTITION_EQUALLY) != partitions.end();
        f.max_sub_devices = equally ? std::min(device.getInfo<CL_DEVICE_PARTITION_MAX_SUB_DEVICES>(), f.compute_units) : 0;
    }
    return f;
}

PlatformFacts facts_of(const cl::Platform& handle) {
    PlatformFacts platform;
    std::vector<cl::Device> devices;
    try {
        platform.name = trimmed(handle.getInfo<CL_PLATFORM_NAME>());
        platform.vendor = trimmed(handle.getInfo<CL_PLATFORM_VENDOR>());
        platform.version = trimmed(handle.getInfo<CL_PLATFORM_VERSION>());
        handle.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error& error) {
        spdlog::warn("OpenCL platform \"{}\" is broken: {}", platform.name, translated(error, {}).line());
    }
    for (const cl::Device& device : devices) {
        try {
            platform.devices.push_back(facts_of(device, platform.name, platform.version));
        } catch (const cl::Error& error) {
            spdlog::warn("a device of OpenCL platform \"{}\" is broken: {}", platform.name, translated(error, {}).line());
        }
    }
    return platform;
}

} // namespace

std::string why_unusable(const DeviceFacts& device) {
    if (!device.driver_problem.empty()) return device.driver_problem;
    if (!device.available) return "is not available now";
    if (!device.has_compiler) return "has no OpenCL compiler";
    if (!offers_1_2(device.version)) return fmt::format("offers \"{}\", clvr needs OpenCL 1.2", device.version);
    return {};
}

const char* type_name(DeviceType type) { return type == DeviceType::cpu ? "cpu" : type == DeviceType::gpu ? "gpu" : "accelerator"; }

std::vector<DeviceFacts> divide(const DeviceFacts& root, int parts) {
    const unsigned count = static_cast<unsigned>(parts);
    if (parts < 2 || count > root.max_sub_devices || count > root.compute_units)
        throw Error(ErrorKind::device,
                    root.max_sub_devices ? fmt::format("cannot be divided into {} parts, at most {}", parts, root.max_sub_devices)
                                         : "cannot be divided into parts",
                    root.name);
    return cl_check(fmt::format("dividing {} into {} parts", root.name, parts), [&] {
        const cl_device_partition_property equally[] = {CL_DEVICE_PARTITION_EQUALLY,
                                                        static_cast<cl_device_partition_property>(root.compute_units / count), 0};
        cl::Device handle = root.handle;
        std::vector<cl::Device> handles;
        handle.createSubDevices(equally, &handles);
        if (handles.size() < count)
            throw Error(ErrorKind::device, fmt::format("gave {} parts where {} were wanted", handles.size(), parts), root.name);
        handles.resize(count); // more come when the compute units do not divide
        std::vector<cl::Device> family = handles;
        family.push_back(root.handle);
        const cl::Context context(family);
        std::vector<DeviceFacts> facts;
        for (const cl::Device& part : handles) {
            facts.push_back(facts_of(part, root.platform, root.platform_version));
            facts.back().index = root.index;
            facts.back().sub_device = static_cast<int>(facts.size()) - 1;
            facts.back().sub_devices = parts;
            facts.back().context = context;
        }
        return facts;
    });
}

std::vector<PlatformFacts> list_platforms() {
    static const DriverProblems problems = [] {
        if (!quirks::pocl_hides_devices_without_writable_cache()) // tests come here without run_program
            spdlog::warn("no folder for compiled kernels can be written (HOME and the temporary folder); PoCL will show no device");
        return try_drivers();
    }();
    if (problems.count(-1)) throw Error(ErrorKind::device, fmt::format("an OpenCL driver on this machine {}", problems.at(-1)));
    std::vector<cl::Platform> handles;
    try {
        cl::Platform::get(&handles);
    } catch (const cl::Error& error) {
        if (error.err() != -1001) spdlog::warn("{}", translated(error, "listing OpenCL platforms").line()); // -1001: the loader found none
    }
    std::vector<PlatformFacts> platforms;
    int index = 0;
    for (const cl::Platform& handle : handles) {
        platforms.push_back(facts_of(handle));
        PlatformFacts& platform = platforms.back();
        if (const auto found = problems.find(static_cast<int>(platforms.size()) - 1); found != problems.end())
            platform.problem = found->second;
        for (DeviceFacts& device : platform.devices) {
            device.index = index++;
            if (!platform.problem.empty()) device.driver_problem = fmt::format("the driver {} {}", platform.name, platform.problem);
        }
    }
    return platforms;
}

std::vector<DeviceFacts> list_devices() {
    std::vector<DeviceFacts> devices;
    for (const PlatformFacts& platform : list_platforms()) devices.insert(devices.end(), platform.devices.begin(), platform.devices.end());
    return devices;
}

} // namespace clvr
