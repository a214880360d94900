#include "host/view/volume_facts.hpp"
#include "host/render/framing.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace clvr::view {

namespace {

using nlohmann::ordered_json;

const char* type_of(const Voxels& v) {
    switch (v.type) {
    case VoxelType::u8:
        return "uint8";
    case VoxelType::i8:
        return "int8";
    case VoxelType::u16:
        return "uint16";
    case VoxelType::i16:
        return "int16";
    case VoxelType::f32:
        return "float32";
    }
    return "";
}

/// Whether the axes of its world are a patient's.
bool is_anatomical(const Voxels& v) {
    for (const char* format : {"DICOM", "NIfTI", "NRRD", "MetaImage", "MGH", "FreeSurfer", "MINC"})
        if (v.format.compare(0, std::string(format).size(), format) == 0) return true;
    return v.source == "demo:head" || v.source == "demo:skull";
}

/// Over physical values, which ascend; half as many bins as the stored one has.
ordered_json histogram_json(const Voxels& v, Histogram histogram) {
    double low = v.slope * histogram.low + v.intercept, high = v.slope * histogram.high + v.intercept;
    if (v.slope < 0) std::swap(low, high), std::reverse(histogram.bins.begin(), histogram.bins.end());
    ordered_json counts = ordered_json::array();
    for (std::size_t i = 0; i + 1 < histogram.bins.size(); i += 2) counts.push_back(histogram.bins[i] + histogram.bins[i + 1]);
    return {{"low", low}, {"high", high}, {"counts", std::move(counts)}};
}

ordered_json index_to_world(const Geometry& geometry) {
    const Matrix3 m = geometry.index_to_world();
    ordered_json rows = ordered_json::array();
    for (std::size_t r = 0; r < 3; ++r)
        for (const double x : {m.row[r][0], m.row[r][1], m.row[r][2], geometry.origin[r]}) rows.push_back(x);
    return rows;
}

} // namespace

ordered_json volume_json(const PreparedVolume& volume, const std::string& name, int time_steps, int time_step) {
    const Voxels& v = volume.voxels;
    const Histogram stored = stored_histogram(v);
    const ordered_json histogram = histogram_json(v, stored);
    const ordered_json facts{{"name", name},
                             {"size", v.dims},
                             {"spacing", v.geometry.spacing},
                             {"type", type_of(v)},
                             {"range", {histogram["low"], histogram["high"]}},
                             {"unit", v.modality == "CT" ? "HU" : ""},
                             {"time_steps", time_steps},
                             {"time_step", time_step},
                             {"index_to_world", index_to_world(v.geometry)},
                             {"histogram", histogram},
                             {"anatomical", is_anatomical(v)}};
    return {{"volume", facts}, {"automatic", ordered_json::parse(to_json(automatic_transfer_function(v, stored)))}};
}

namespace {

/// The wanted direction, or the picture's own where one looks along it.
Double3 up_of(const Camera& camera, const View& view) {
    return norm(cross(view.forward, camera.up)) > 1e-5 * norm(camera.up) ? camera.up : unit(view.up);
}

} // namespace

PlacedCamera placed_camera(const Scene& scene, const PreparedVolume& volume) {
    const Camera& camera = scene.camera;
    const double spread = 2 * std::tan(camera.fov / 2 * radian);
    if (camera.eye && camera.target) {
        const double height = camera.height > 0 ? camera.height : spread * norm(*camera.target - *camera.eye);
        return {*camera.eye, *camera.target, camera.up, camera.fov, height};
    }
    const std::vector<Double3> outline = framing_outline(classify(volume, scene.transfer), scene);
    const View view = resolve_view(scene, outline, false);
    const double distance = inner(centre_of(outline) - view.eye, view.forward);
    const double height = camera.orthographic ? 2 * norm(view.up) * camera.zoom : spread * distance;
    return {view.eye, view.eye + view.forward * distance, up_of(camera, view), camera.fov, height};
}

Scene with_camera(Scene scene, const PlacedCamera& camera) {
    scene.camera.eye = camera.eye, scene.camera.target = camera.target, scene.camera.up = camera.up;
    if (scene.camera.orthographic) scene.camera.height = camera.height;
    return scene;
}

PlacedCamera turned(PlacedCamera camera, double degrees) {
    const double c = std::cos(degrees * radian), s = std::sin(degrees * radian);
    const auto around_z = [&](const Double3& v) { return Double3{c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]}; };
    camera.eye = camera.target + around_z(camera.eye - camera.target);
    camera.up = around_z(camera.up);
    return camera;
}

} // namespace clvr::view
