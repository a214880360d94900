#include "host/io/scene/scene_inputs.hpp"
#include "host/io/picture/frame_file.hpp"

namespace clvr {

EnvironmentTables read_environment(const Scene& scene, std::vector<std::string>* notes) {
    if (scene.light.environment != Light::Environment::image) return {};
    const RgbImage image = read_environment_image(scene.light.image);
    if (notes) *notes = image.notes;
    return environment_tables(image.width, image.height, image.rgb, scene.light.level);
}

} // namespace clvr
