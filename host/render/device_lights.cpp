#include "host/render/device_lights.hpp"

namespace clvr {

DeviceLights::DeviceLights(Device& device, const shared::RenderParams& params, const EnvironmentTables& environment)
    : render_(device.upload(std::vector<shared::RenderParams>{params}, "render parameters")),
      texel_(device.upload(environment.texel, "environment")), row_cdf_(device.upload(environment.row_cdf, "environment rows")),
      column_cdf_(device.upload(environment.column_cdf, "environment columns")),
      row_cos_(device.upload(environment.row_cos, "environment row angles")) {}

void DeviceLights::set_view(Device& device, const shared::RenderParams& params) { device.write(render_, &params, sizeof params); }

} // namespace clvr
