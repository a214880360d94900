#include "runtime/drivers/check.hpp"

#include <fmt/format.h>

#include <map>

namespace clvr {

std::string status_name(cl_int status) {
#define CLVR_STATUS(name)                                                                                                                  \
    { name, #name }
    static const std::map<cl_int, const char*> names{
        CLVR_STATUS(CL_SUCCESS),
        CLVR_STATUS(CL_DEVICE_NOT_FOUND),
        CLVR_STATUS(CL_DEVICE_NOT_AVAILABLE),
        CLVR_STATUS(CL_COMPILER_NOT_AVAILABLE),
        CLVR_STATUS(CL_MEM_OBJECT_ALLOCATION_FAILURE),
        CLVR_STATUS(CL_OUT_OF_RESOURCES),
        CLVR_STATUS(CL_OUT_OF_HOST_MEMORY),
        CLVR_STATUS(CL_PROFILING_INFO_NOT_AVAILABLE),
        CLVR_STATUS(CL_MEM_COPY_OVERLAP),
        CLVR_STATUS(CL_IMAGE_FORMAT_MISMATCH),
        CLVR_STATUS(CL_IMAGE_FORMAT_NOT_SUPPORTED),
        CLVR_STATUS(CL_BUILD_PROGRAM_FAILURE),
        CLVR_STATUS(CL_MAP_FAILURE),
        CLVR_STATUS(CL_MISALIGNED_SUB_BUFFER_OFFSET),
        CLVR_STATUS(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST),
        CLVR_STATUS(CL_COMPILE_PROGRAM_FAILURE),
        CLVR_STATUS(CL_LINKER_NOT_AVAILABLE),
        CLVR_STATUS(CL_LINK_PROGRAM_FAILURE),
        CLVR_STATUS(CL_DEVICE_PARTITION_FAILED),
        CLVR_STATUS(CL_KERNEL_ARG_INFO_NOT_AVAILABLE),
        CLVR_STATUS(CL_INVALID_VALUE),
        CLVR_STATUS(CL_INVALID_DEVICE_TYPE),
        CLVR_STATUS(CL_INVALID_PLATFORM),
        CLVR_STATUS(CL_INVALID_DEVICE),
        CLVR_STATUS(CL_INVALID_CONTEXT),
        CLVR_STATUS(CL_INVALID_QUEUE_PROPERTIES),
        CLVR_STATUS(CL_INVALID_COMMAND_QUEUE),
        CLVR_STATUS(CL_INVALID_HOST_PTR),
        CLVR_STATUS(CL_INVALID_MEM_OBJECT),
        CLVR_STATUS(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR),
        CLVR_STATUS(CL_INVALID_IMAGE_SIZE),
        CLVR_STATUS(CL_INVALID_SAMPLER),
        CLVR_STATUS(CL_INVALID_BINARY),
        CLVR_STATUS(CL_INVALID_BUILD_OPTIONS),
        CLVR_STATUS(CL_INVALID_PROGRAM),
        CLVR_STATUS(CL_INVALID_PROGRAM_EXECUTABLE),
        CLVR_STATUS(CL_INVALID_KERNEL_NAME),
        CLVR_STATUS(CL_INVALID_KERNEL_DEFINITION),
        CLVR_STATUS(CL_INVALID_KERNEL),
        CLVR_STATUS(CL_INVALID_ARG_INDEX),
        CLVR_STATUS(CL_INVALID_ARG_VALUE),
        CLVR_STATUS(CL_INVALID_ARG_SIZE),
        CLVR_STATUS(CL_INVALID_KERNEL_ARGS),
        CLVR_STATUS(CL_INVALID_WORK_DIMENSION),
        CLVR_STATUS(CL_INVALID_WORK_GROUP_SIZE),
        CLVR_STATUS(CL_INVALID_WORK_ITEM_SIZE),
        CLVR_STATUS(CL_INVALID_GLOBAL_OFFSET),
        CLVR_STATUS(CL_INVALID_EVENT_WAIT_LIST),
        CLVR_STATUS(CL_INVALID_EVENT),
        CLVR_STATUS(CL_INVALID_OPERATION),
        CLVR_STATUS(CL_INVALID_GL_OBJECT),
        CLVR_STATUS(CL_INVALID_BUFFER_SIZE),
        CLVR_STATUS(CL_INVALID_MIP_LEVEL),
        CLVR_STATUS(CL_INVALID_GLOBAL_WORK_SIZE),
        CLVR_STATUS(CL_INVALID_PROPERTY),
        CLVR_STATUS(CL_INVALID_IMAGE_DESCRIPTOR),
        CLVR_STATUS(CL_INVALID_COMPILER_OPTIONS),
        CLVR_STATUS(CL_INVALID_LINKER_OPTIONS),
        CLVR_STATUS(CL_INVALID_DEVICE_PARTITION_COUNT),
        {-1001, "CL_PLATFORM_NOT_FOUND_KHR"},
    };
#undef CLVR_STATUS
    const auto found = names.find(status);
    return found == names.end() ? fmt::format("status {}", status) : found->second;
}

Error translated(const cl::Error& error, const std::string& where) {
    const cl_int status = error.err();
    const bool memory = status == CL_MEM_OBJECT_ALLOCATION_FAILURE || status == CL_OUT_OF_RESOURCES || status == CL_OUT_OF_HOST_MEMORY ||
                        status == CL_INVALID_BUFFER_SIZE;
    std::string text = fmt::format("{} failed with {} ({})", error.what(), status_name(status), status);
    if (memory) text += "; try a lower --memory, a smaller picture or another --device";
    return Error(memory ? ErrorKind::device_memory : ErrorKind::device, text, where);
}

} // namespace clvr
