// OpenCL statuses by name, and the one place where cl::Error becomes clvr::Error.
#pragma once
#include "runtime/drivers/opencl.hpp"
#include "runtime/error.hpp"

#include <string>
#include <type_traits>
#include <utility>

namespace clvr {

/// "CL_OUT_OF_RESOURCES" for -5; "status -9999" for a number that no header names.
std::string status_name(cl_int status);

/// The Error that stands for a failed OpenCL call: names the call and the status. Out of memory or of resources is
/// ErrorKind::device_memory, the rest ErrorKind::device. `where` says what was attempted and on which device.
Error translated(const cl::Error& error, const std::string& where);

/// Runs `call`, which may use the C++ bindings; a cl::Error leaves it as clvr::Error. `where` is a text, or a function that makes it:
/// called only when something failed, as a launch is too short to write sentences beside it.
template <class Where, class Call>
auto cl_check(Where&& where, Call&& call) -> decltype(std::forward<Call>(call)()) {
    try {
        return std::forward<Call>(call)();
    } catch (const cl::Error& error) {
        if constexpr (std::is_invocable_v<Where>)
            throw translated(error, where());
        else
            throw translated(error, where);
    }
}

} // namespace clvr
