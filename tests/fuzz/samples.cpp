#include "tests/fuzz/samples.hpp"

#include "host/appearance/embedded_presets.hpp"
#include "host/dataset/embedded_manifests.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/view/scene_form.hpp"
#include "runtime/system/embedded.hpp"
#include "tests/fuzz/volume_samples.hpp"
#include "tests/io/exr_writers.hpp"
#include "tests/io/volume_writers.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

namespace clvr::test {

namespace {

using Samples = std::vector<FuzzSample>;

/// What a writer to a path writes.
std::string written(const std::function<void(const std::string& path)>& write) {
    const Folder folder;
    write(folder / "a");
    return read(folder / "a");
}

Samples of_map(const std::map<std::string, std::string>& files) {
    Samples samples;
    for (const auto& [name, text] : files) samples.push_back({name, text});
    return samples;
}

Frame frame_of(const std::vector<std::string>& channels) {
    Frame frame;
    frame.width = 5, frame.height = 3;
    std::size_t i = 0;
    for (const std::string& name : channels)
        for (float& x : frame.channel(name)) x = static_cast<float>(i++ % 7) / 4;
    frame.attributes = {{"clvr.spp", "16"}, {"clvr.scene", "{}"}};
    return frame;
}
std::string exr_of(const std::vector<std::string>& channels) {
    return written([&](const std::string& path) { write_exr(frame_of(channels), path); });
}

Samples radiance_samples() {
    const std::string head = "#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n";
    std::string flat, runs;
    for (int i = 0; i < 12; ++i) flat += {static_cast<char>(i), static_cast<char>(2 * i), '\xff', '\x80'};
    for (int y = 0; y < 2; ++y)
        runs += std::string("\2\2\0\11", 4) + "\x89\x10" + std::string("\4abcd\x85\x07", 7) + "\x89\x20" + "\x89\x81";
    return {{"flat", head + "-Y 2 +X 6\n" + flat}, {"runs", head + "-Y 2 +X 9\n" + runs}};
}

Samples environment_samples() {
    Samples samples = radiance_samples();
    samples.push_back({"exr", exr_of({"R", "G", "B"})});
    return samples;
}

/// All that a scene may say.
Scene full_scene() {
    Scene s;
    s.volume = "data/a \"b\" \xc3\xbc.nii.gz";
    s.volume_sha256 = std::string(64, 'a');
    s.reading.channel = 1;
    s.reading.array = "density";
    s.reading.recursive = true;
    s.reading.dims = Int3{7, 8, 9};
    s.reading.spacing = Double3{0.1, 1.0 / 3, 2};
    s.transfer = transfer_preset("ct-bone");
    s.camera.eye = Double3{1, 2, -0.0};
    s.camera.target = Double3{1e30, 5, 6};
    s.light.environment = Light::Environment::image;
    s.light.image = "sky.hdr";
    s.clip_box = std::array<double, 6>{0, 0.1, 0.2, 1, 0.9, 0.8};
    s.clip_plane = ClipPlane{{1, -1, 0.5}, -17};
    return s;
}

Samples scene_samples() {
    Scene plain;
    plain.volume = "demo:head";
    return {{"plain", to_json(plain)}, {"full", to_json(full_scene())}, {"short", R"({"clvr.format": "scene/1", "volume": "a.nii"})"}};
}

Samples transfer_function_samples() {
    Samples samples = of_map(embedded_presets());
    for (const char* space : {"RGB", "HSV", "Lab", "Diverging", "Step"})
        samples.push_back(
            {space,
             fmt::format(R"([{{"ColorSpace": "{}", "Name": "map", "RGBPoints": [0, 0.2, 0.3, 0.7, 10, 0.9, 0.9, 0.8, 90, 0.7, 0, 0.1],
                                              "Points": [0, 0, 0.5, 0, 20, 0.4, 0.3, 0.6, 90, 1, 0.5, 1]}}])",
                         space)});
    return samples;
}

Samples view_message_samples() {
    const auto text = [](const char* type, const std::string& file) {
        return nlohmann::json{{"type", type}, {"id", 1}, {"text", file}}.dump();
    };
    Scene lit = full_scene();
    lit.volume = "demo:head";
    Samples samples{
        {"hello", R"({"type":"hello","token":"0123456789abcdef","role":"control"})"},
        {"scene", R"({"type":"scene","generation":9007199254740991,"scene":)" + view::SceneForm(lit).to_page(lit) + "}"},
        {"image", R"({"type":"scene","generation":1,"scene":{"light":{"environment":"image","image":"scene"}}})"},
        {"ack", R"({"type":"ack","number":4294967295})"},
        {"pause", R"({"type":"pause","paused":true})"},
        {"take_control", R"({"type":"take_control"})"},
        {"pick", R"({"type":"pick","id":3,"x":0.5,"y":1})"},
        {"time_step", R"({"type":"time_step","step":2})"},
        {"save", R"({"type":"save","id":4,"what":"turntable","format":"png","width":640,"height":480,"samples":64,"views":72})"},
        {"cancel", R"({"type":"cancel","job":"1"})"},
        {"scene_text", text("scene_text", to_json(lit))},
        {"transfer_text", text("transfer_text", to_json(transfer_preset("ct-bone")))}};
    return samples;
}

Samples model_samples() {
    Model m;
    m.channels = {"R", "G", "B", "depth.Z"};
    m.hidden = 2;
    m.kernel = 3;
    m.levels = {{4, 8}, {16, 16}};
    m.notes["clvr.training"] = R"({"epochs": 3})";
    initialise(m, 7);
    Model reference = m;
    reference.channels = reference_channels();
    reference.kernel = 1;
    reference.levels = Model().levels;
    initialise(reference, 7);
    TensorFile bare = tensors_of(reference);
    bare.metadata.clear();
    return {{"settings", written([&](const std::string& path) { write_model(m, path); })},
            {"bare", written([&](const std::string& path) { write_tensors(bare, path); })}};
}

Samples tensor_samples() {
    Samples samples = model_samples();
    TensorFile several;
    several.tensors = {{"a", float_tensor({2, 1}, {1, 2})}, {"b", integer_tensor({}, {3})}, {"empty", float_tensor({0, 4}, {})}};
    samples.push_back({"several", written([&](const std::string& path) { write_tensors(several, path); })});
    return samples;
}

/// Of what is no volume.
const std::map<std::string, Samples (*)()>& other_samples() {
    static const std::map<std::string, Samples (*)()> samples{
        {"exr",
         [] {
             return Samples{
                 {"rgb", exr_of({"R", "G", "B"})},
                 {"all", exr_of({"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z",
                                 "depth.deviation", "depth.half", "opacity.A", "variance.R", "variance.G", "variance.B"})},
                 {"background", exr_of({"R", "G", "B", "A", "background.R", "background.G", "background.B"})}};
         }},
        {"png",
         [] {
             return Samples{{"rgb", written([](const std::string& path) {
                                 write_png(frame_of({"R", "G", "B"}), {}, path);
                             })},
                            {"rgba", written([](const std::string& path) {
                                 write_png(frame_of({"R", "G", "B", "A"}), {}, path);
                             })}};
         }},
        {"environment", environment_samples},
        {"radiance", radiance_samples},
        {"pfm",
         [] {
             return Samples{{"grey", "Pf\n2 2\n-1.0\n0123456789abcdef"}, {"rgb", "PF\n1 1\n1.0\n0123456789ab"}};
         }},
        {"jpeg",
         [] {
             return Samples{{"rgb", written([](const std::string& path) { write_jpeg(frame_of({"R", "G", "B"}), {}, path); })}};
         }},
        {"scene", scene_samples},
        {"transfer_function", transfer_function_samples},
        {"view_message", view_message_samples},
        {"model", model_samples},
        {"tensors", tensor_samples},
        {"tuning",
         [] {
             return Samples{{"measured", R"({"format": "clvr tuning 1", "platform": "p", "platform_version": "1", "device": "d",
                                             "driver_version": "3.1", "tunables": {"packet": 8, "splat_bins": 7}, "evidence": ["packet 8: 1.2 x"]})"}};
         }},
        {"shipped_tuning", [] { return of_map(embedded_tuning()); }},
        {"tunables",
         [] {
             return Samples{{"two", "packet=8,splat_bins=7"}, {"one", "tile_pixels=100"}};
         }},
        {"remembered",
         [] {
             return Samples{{"tasks", R"({"devices": [{"platform": "p", "name": "n", "occurrence": 0, "sub_devices": 0}],
                                          "tasks": {"render": [{"platform": "p", "name": "n", "occurrence": 1, "sub_devices": 2}]}})"}};
         }},
        {"manifest", [] { return of_map(embedded_manifests()); }},
    };
    return samples;
}

} // namespace

std::vector<FuzzSample> fuzz_samples(const FuzzTarget& target) {
    if (const auto other = other_samples().find(target.name); other != other_samples().end()) return other->second();
    return volume_samples(target);
}

} // namespace clvr::test
