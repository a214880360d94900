// The light on one device: the arguments LIGHT_ARGS of the kernels.
#pragma once
#include "host/render/environment.hpp"
#include "kernels/shared/render_params.h"
#include "runtime/device.hpp"

namespace clvr {

class LightTables {
public:
    LightTables(Device& device, const shared::RenderParams& params, const EnvironmentTables& environment);
    /// LIGHT_ARGS, in order.
    BufferList arguments() const { return {&render_, &texel_, &row_cdf_, &column_cdf_, &row_cos_}; }
    /// The RenderParams alone.
    const Buffer& render() const { return render_; }

private:
    Buffer render_, texel_, row_cdf_, column_cdf_, row_cos_;
};

} // namespace clvr
