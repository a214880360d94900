#include "host/render/light_tables.hpp"

namespace clvr {

LightTables::LightTables(Device& device, const shared::RenderParams& params, const EnvironmentTables& environment)
    : render_(device.upload(std::vector<shared::RenderParams>{params}, "render parameters")),
      texel_(device.upload(environment.texel, "environment")), row_cdf_(device.upload(environment.row_cdf, "environment rows")),
      column_cdf_(device.upload(environment.column_cdf, "environment columns")),
      row_cos_(device.upload(environment.row_cos, "environment row angles")) {}

} // namespace clvr
