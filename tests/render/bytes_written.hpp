// What a call sends to a device.
#pragma once
#include "runtime/opencl/device.hpp"

namespace clvr::testing {

/// Bytes written to the device by a call (uploads and fills' commands are not writes).
template <class Call>
double bytes_written(Device& device, Call&& call) {
    const auto written = [&] {
        device.finish();
        double bytes = 0;
        for (const ProfileRow& row : device.profile().rows())
            if (row.label == "write") bytes += row.bytes;
        return bytes;
    };
    const double before = written();
    call();
    return written() - before;
}

} // namespace clvr::testing
