#include "host/pairs/plan.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/io/volume/volume_file.hpp"
#include "host/pairs/folder.hpp"
#include "host/render/params.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {

using nlohmann::ordered_json;

std::string to_json(const PairsPlan& p) {
    ordered_json views = ordered_json::array(), scenes = ordered_json::array();
    for (const auto& v : p.views) views.push_back({{"azimuth", v.azimuth}, {"elevation", v.elevation}, {"zoom", v.zoom}});
    for (const auto& s : p.scenes) scenes.push_back(ordered_json::parse(to_json(s)));
    const ordered_json all{{format_key, pairs_format},       {"split", p.split}, {"spp", p.spp},   {"reference_spp", p.reference_spp},
                           {"noisy_frames", p.noisy_frames}, {"seed", p.seed},   {"views", views}, {"scenes", scenes}};
    return all.dump(1) + "\n";
}

PairsPlan parse_pairs_plan(const std::string& text, const std::string& where) {
    try {
        const auto j = nlohmann::json::parse(text);
        if (j.at(format_key) != pairs_format)
            throw Error(ErrorKind::input, fmt::format("is of another format; expected {}", pairs_format), where);
        PairsPlan p{j.at("split").get<std::string>(),
                    j.at("spp").get<std::vector<int>>(),
                    j.at("reference_spp").get<int>(),
                    j.at("noisy_frames").get<int>(),
                    j.at("seed").get<std::uint64_t>(),
                    {},
                    {}};
        for (const auto& v : j.at("views"))
            p.views.push_back({v.at("azimuth").get<double>(), v.at("elevation").get<double>(), v.at("zoom").get<double>()});
        for (const auto& s : j.at("scenes")) p.scenes.push_back(parse_scene(s.dump(), where));
        if (p.views.empty() || p.scenes.empty() || p.spp.empty()) throw Error(ErrorKind::input, "names no views", where);
        return p;
    } catch (const nlohmann::json::exception&) {
        throw Error(ErrorKind::input, "is damaged, or not what `clvr pairs` writes", where);
    }
}

std::vector<ViewPoint> split_views(const std::string& split, std::uint64_t seed, int count, double zoom_low, double zoom_high) {
    return view_set(count, seed + (split == "test" ? 0x5bd1e995u : 0), zoom_low, zoom_high);
}

Scene frame_scene(const PairsPlan& plan, int view, int role) {
    const auto v = static_cast<std::size_t>(view);
    Scene scene = plan.scenes[v % plan.scenes.size()];
    // Independent for every frame of a view.
    scene.seed = plan.seed + (plan.split == "test" ? 0x8000000000000000u : 0) + static_cast<std::uint64_t>(role) * 0x9e3779b97f4a7c15u;
    scene.spp = role == 0 ? plan.reference_spp : plan.spp[static_cast<std::size_t>(role - 1) % plan.spp.size()];
    scene.features = role != 0;
    scene.camera.azimuth = plan.views[v].azimuth;
    scene.camera.elevation = plan.views[v].elevation;
    scene.camera.zoom *= plan.views[v].zoom;
    scene.view = view;
    return scene;
}

void settle(PairsPlan& plan, const PreparedVolume& volume) {
    const std::string hash = volume_sha256(volume.voxels);
    for (Scene& s : plan.scenes) {
        if (!s.volume_sha256.empty() && s.volume_sha256 != hash)
            throw Error(ErrorKind::input,
                        fmt::format("does not hold the voxels of the pairs (SHA-256 {}, expected {})", hash, s.volume_sha256), s.volume);
        s.volume_sha256 = hash;
        if (!s.transfer) s.transfer = automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels));
        s.extinction = resolved_extinction(s, volume.voxels);
    }
}

} // namespace clvr
