#include "host/io/scene_inputs.hpp"
#include "host/io/frame_file.hpp"

namespace clvr {

VolumeReadOptions reading_options(const Scene& s) {
    return {s.frame, s.series, s.allow_gaps, s.raw.dims, s.raw.type, s.raw.spacing, s.raw.endian};
}

EnvironmentTables read_environment(const Scene& scene) {
    if (scene.light.environment != Light::Environment::image) return {};
    const RgbImage image = read_environment_image(scene.light.image);
    return environment_tables(image.width, image.height, image.rgb, scene.light.level);
}

} // namespace clvr
