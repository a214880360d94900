// Rendering, and the computing of a volume.
#include "host/phantom/phantom.hpp"
#include "host/render/marcher.hpp"
#include "tools/bench/bench_scene.hpp"
#include "tools/bench/stage.hpp"

namespace clvr::bench {
namespace {

int edge_of(Size size) { return size == Size::tiny ? 24 : 192; }

StageRun path_trace(std::vector<Device>& devices, Size size) {
    const Scene scene = size == Size::tiny ? benchmark_scene(8, 8, 1) : benchmark_scene(320, 240, 4);
    const auto session = std::make_shared<RenderSession>(devices, prepared_volume(edge_of(size)), scene);
    const auto frame = std::make_shared<Frame>();
    StageRun r;
    r.run = [=] { *frame = clvr::render(*session, scene); };
    r.hash = [=] { return pixel_hash(*frame); };
    r.items = static_cast<double>(scene.width) * scene.height * scene.spp;
    return r;
}

StageRun feature_march(std::vector<Device>& devices, Size size) {
    Device d = devices.front();
    const Scene scene = size == Size::tiny ? benchmark_scene(8, 8, 1) : benchmark_scene(320, 240, 1);
    const auto parts = std::make_shared<SceneOnDevice>(d, prepared_volume(edge_of(size)), scene);
    const auto marcher = std::make_shared<Marcher>(d, *parts->volume, *parts->light, *parts->keys, *parts->sky, 1);
    const auto planes = std::make_shared<std::vector<float>>(march_planes(March::features) * std::size_t{parts->pixels});
    StageRun r;
    r.run = [=] { marcher->run(0, parts->pixels, *planes, parts->pixels, 0); };
    r.hash = [=] { return hash_of(*planes); };
    r.items = parts->pixels;
    return r;
}

StageRun compute_volume(std::vector<Device>& devices, Size size) {
    const auto d = std::make_shared<Device>(devices.front());
    const int edge = size == Size::tiny ? 6 : 64;
    const auto voxels = std::make_shared<Voxels>();
    StageRun r;
    r.run = [=] { *voxels = make_phantom(*d, "head", {Int3{edge, edge, edge}}); };
    r.hash = [=] { return hash_of(std::vector<float>(voxels->data<std::int16_t>(), voxels->data<std::int16_t>() + voxels->count())); };
    r.items = 1.0 * edge * edge * edge;
    return r;
}

} // namespace

std::vector<Stage> render_stages() {
    return {{"path trace", "Mpaths/s", 1e6, Ceiling::none, "render", true, "", path_trace},
            {"feature march", "Mrays/s", 1e6, Ceiling::none, "", true, "", feature_march},
            {"compute volume", "Mvoxels/s", 1e6, Ceiling::none, "", true, "", compute_volume}};
}

} // namespace clvr::bench
