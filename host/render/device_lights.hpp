// View and lights on one device: the arguments LIGHT_ARGS of the kernels.
#pragma once
#include "host/appearance/environment.hpp"
#include "kernels/shared/render_params.h"
#include "runtime/opencl/device.hpp"

namespace clvr {

class DeviceLights {
public:
    DeviceLights(Device& device, const shared::RenderParams& params, const EnvironmentTables& environment);
    /// Another camera under the same environment: writes sizeof(RenderParams) bytes, behind what is enqueued.
    void set_view(Device& device, const shared::RenderParams& params);
    /// LIGHT_ARGS, in order.
    BufferList arguments() const { return {&render_, &texel_, &row_cdf_, &column_cdf_, &row_cos_}; }
    /// The RenderParams alone.
    const Buffer& render() const { return render_; }

private:
    Buffer render_, texel_, row_cdf_, column_cdf_, row_cos_;
};

} // namespace clvr
