#include "tests/fuzz/targets.hpp"

#include "host/appearance/environment.hpp"
#include "host/appearance/transfer_function.hpp"
#include "host/dataset/manifest.hpp"
#include "host/denoise/channels.hpp"
#include "host/io/dicom/file.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"
#include "host/view/messages.hpp"
#include "host/view/scene_form.hpp"
#include "runtime/choose/remembered.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/tune/tuning.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>

namespace clvr::test {

namespace {

namespace fs = std::filesystem;

void require(bool holds, const char* what) {
    if (!holds) throw std::logic_error(what);
}

/// Accepts a proper refusal only: of the right kind, of one line, with a place.
void check_refusal(const Error& e, ErrorKind kind) {
    require(e.kind() == kind, "an error of another kind");
    require(e.line().find('\n') == std::string::npos, "an error of several lines");
    require(!e.where().empty(), "an error without a place");
}

// --- volumes

/// Finishes what a reader returns, as read_volume does.
void check_volume(Voxels v) {
    require(v.dims[0] > 0 && v.dims[1] > 0 && v.dims[2] > 0, "a volume without voxels");
    require(v.bytes.size() == v.count() * voxel_bytes(v.type), "a volume with other bytes than its size says");
    check_geometry(v.geometry, "geometry");
    repair(v);
    require(std::isfinite(v.slope) && std::isfinite(v.intercept) && v.slope != 0, "a scale that is not finite, or 0");
    if (v.type == VoxelType::f32)
        require(std::all_of(v.data<float>(), v.data<float>() + v.count(), [](float x) { return std::isfinite(x); }),
                "a voxel that is not finite");
    for (const auto& lines : {v.notes, v.decisions})
        for (const std::string& line : lines) require(line.find('\n') == std::string::npos, "a note of several lines");
}

using VolumeReader = Voxels (*)(const std::string& path, const VolumeReadOptions& options);

/// With the defaults, then as the second of everything that a file may hold.
template <VolumeReader reader>
void volume(const std::string& path) {
    check_volume(reader(path, {}));
    VolumeReadOptions frame, channel;
    frame.frame = 1;
    channel.channel = 1;
    for (const VolumeReadOptions& options : {frame, channel}) {
        try {
            check_volume(reader(path, options));
        } catch (const Error& e) {
            check_refusal(e, ErrorKind::input);
        }
    }
}

Voxels tiff(const std::string& path, const VolumeReadOptions& options) { return read_tiff(path, {path}, options); }
Voxels png_slice(const std::string& path, const VolumeReadOptions& options) { return read_png_slices(path, {path}, options); }
Voxels jpeg_slice(const std::string& path, const VolumeReadOptions& options) { return read_jpeg_slices(path, {path}, options); }
Voxels folder(const std::string& path, const VolumeReadOptions& options) {
    return read_volume(fs::path(path).parent_path().string(), options);
}

/// Compressed pixels are decoded in a child process, which takes long: those files end with their structure.
void dicom(const std::string& path) {
    for (const auto& file : fs::directory_iterator(fs::path(path).parent_path()))
        if (scan_dicom(file.path().string()).encapsulated) return;
    volume<read_dicom>(path);
}

// --- pictures

void check_frame(const Frame& frame) {
    require(frame.width > 0 && frame.height > 0 && !frame.channels.empty(), "a frame without pixels");
    for (const auto& [name, values] : frame.channels) require(values.size() == frame.pixels(), "a channel of another size than its frame");
}

/// Read, shown and prepared for the network.
void exr(const std::string& path) {
    const Frame frame = read_exr(path);
    check_frame(frame);
    if (std::max(frame.pixels(), frame.shown().pixels()) > 1u << 16) return;
    if (frame.has("R") && frame.has("G") && frame.has("B")) encode_png(frame, {});
    static const Model model = read_model("default");
    const ChannelPlan plan(model, false);
    try {
        plan.check(frame);
    } catch (const Error& e) {
        require(e.kind() == ErrorKind::input, "an error of another kind");
        return;
    }
    require(std::isfinite(exposure_of(frame)), "an exposure that is not finite");
    std::vector<float> planes;
    plan.gather(frame, nullptr, {0, 0, frame.width, frame.height}, plan.known_light(frame), planes);
    require(std::all_of(planes.begin(), planes.end(), [](float x) { return std::isfinite(x); }), "a plane that is not finite");
}

template <Frame (*reader)(const std::string& path)>
void picture(const std::string& path) {
    check_frame(reader(path));
}

void environment(const std::string& path) {
    const RgbImage image = read_environment_image(path);
    require(image.rgb.size() == 3u * static_cast<std::size_t>(image.width) * image.height, "an image of another size than it says");
    const EnvironmentTables tables = environment_tables(image.width, image.height, image.rgb, 1);
    require(std::isfinite(tables.mean_luminance), "a luminance that is not finite");
}

// --- descriptions

void scene(const std::string& path) {
    const std::string text = to_json(read_scene(path));
    require(to_json(parse_scene(text, "scene.json")) == text, "a scene that does not come back");
}

void transfer_function(const std::string& path) {
    const TransferFunction tf = parse_transfer_function(read_text(path), path);
    const std::string text = to_json(tf);
    require(to_json(parse_transfer_function(text, "tf.json")) == text, "a transfer function that does not come back");
    Voxels v;
    v.dims = {2, 1, 1};
    v.bytes = {0, 255};
    for (const double slope : {1.0, -0.25}) {
        v.slope = slope;
        TransferTable table;
        try {
            table = tabulate(tf, v, 0, 255);
        } catch (const Error& e) {
            require(e.kind() == ErrorKind::input, "an error of another kind");
            continue;
        }
        require(table.first < table.last && std::isfinite(static_cast<float>(table.index_scale())) && std::isfinite(table.visible_width),
                "a table without width, or without end");
        for (const auto& entries : {table.opacity, table.color})
            require(std::all_of(entries.begin(), entries.end(), [](float x) { return x >= 0 && x <= 1; }), "an entry outside 0..1");
    }
}

/// What a page of `clvr view` says, with what is inside it.
void view_message(const std::string& path) {
    const view::ClientMessage message = view::parse_message(read_text(path));
    Scene first;
    first.volume = "demo:head", first.light.image = "sky.hdr", first.light.environment = Light::Environment::image;
    const view::SceneForm form(first);
    if (const auto* change = std::get_if<view::SceneChange>(&message)) {
        const Scene scene = form.from_page(change->scene);
        require(scene.volume == first.volume, "a volume that a client named");
        require(scene.light.image.empty() || scene.light.image == first.light.image, "a file that a client named");
        require(form.to_page(form.from_page(form.to_page(scene))) == form.to_page(scene), "a scene that does not come back");
    }
    std::vector<std::string> notes;
    if (const auto* file = std::get_if<view::SceneText>(&message)) {
        const Scene scene = form.from_file(file->text, notes);
        require(scene.light.image.empty() || scene.light.image == first.light.image, "a file that a client named");
    }
    if (const auto* file = std::get_if<view::TransferText>(&message)) parse_transfer_function(file->text, "transfer function");
}

void model(const std::string& path) {
    const Model m = read_model(path);
    require(model_of(tensors_of(m), "model").flat() == m.flat(), "a model that does not come back");
}

void tensors(const std::string& path) {
    for (const auto& [name, tensor] : read_tensors(path).tensors) {
        if (tensor.type == "F32") require(tensor.floats().size() == tensor.count(), "a tensor of another size than it says");
        if (tensor.type == "I64") require(tensor.integers().size() == tensor.count(), "a tensor of another size than it says");
    }
}

void tuning(const std::string& path) { parse_tuning(read_text(path), path); }
void shipped_tuning(const std::string& path) { parse_shipped_tuning(read_text(path), path); }
void tunables(const std::string& path) { parse_tunables(read_text(path), path); }
void manifest(const std::string& path) { parse_manifest(read_text(path), path); }

/// `path` is CONFIG/clvr/device.json.
void remembered(const std::string& path) {
    setenv("XDG_CONFIG_HOME", fs::path(path).parent_path().parent_path().c_str(), 1);
    for (const char* task : {"", "render"}) load_remembered(task);
}

/// A file that is there is removed first: ext4 brings one that is truncated and written again to disk at once, which takes 10 ms.
void put(const fs::path& path, std::string_view bytes) {
    std::error_code none;
    fs::remove(path, none);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
    if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
        throw std::runtime_error("cannot write " + path.string());
}

} // namespace

const std::vector<FuzzTarget>& fuzz_targets() {
    static const std::vector<FuzzTarget> targets{
        {"volume", {"volume"}, volume<read_volume>, ErrorKind::input, "*"},
        {"nifti", {"a.nii"}, volume<read_nifti>},
        {"nifti_pair", {"a.hdr", "a.img"}, volume<read_nifti>},
        {"nrrd", {"a.nrrd", "a.raw"}, volume<read_nrrd>},
        {"nrrd_list", {"a.nhdr", "s00.raw", "s01.raw", "s02.raw"}, volume<read_nrrd>},
        {"metaimage", {"a.mha", "a.raw"}, volume<read_metaimage>},
        {"metaimage_list", {"a.mhd", "s00.raw", "s01.raw", "s02.raw"}, volume<read_metaimage>},
        {"vtk", {"a.vtk"}, volume<read_vtk>},
        {"vti", {"a.vti"}, volume<read_vti>},
        {"numpy", {"a.npy"}, volume<read_numpy>},
        {"mrc", {"a.mrc"}, volume<read_mrc>},
        {"mgh", {"a.mgh"}, volume<read_mgh>, ErrorKind::input, "mg"},
        {"hdf5", {"a.h5"}, volume<read_hdf5>},
        {"imaris", {"a.ims"}, volume<read_hdf5>},
        {"tiff", {"a.tif"}, volume<tiff>},
        {"slices", {"stack/8", "stack/9", "stack/10"}, volume<folder>, ErrorKind::input, "*_folder"},
        {"dicom", {"series/0", "series/1", "series/2"}, dicom},
        {"raw", {"a.raw", "a.json"}, volume<read_raw>, ErrorKind::input, "-"}, // the formats' own say all in the file's name
        {"exr", {"a.exr"}, exr},
        {"png", {"a.png"}, picture<read_png>},
        {"png_slice", {"a.png"}, volume<png_slice>},
        {"jpeg_slice", {"a.jpg"}, volume<jpeg_slice>},
        {"pfm", {"a.pfm"}, picture<read_pfm>},
        {"jpeg", {"a.jpg"}, picture<read_jpeg>},
        {"radiance", {"a.hdr"}, picture<read_radiance>},
        {"environment", {"a.hdr"}, environment},
        {"scene", {"a.json"}, scene},
        {"transfer_function", {"a.json"}, transfer_function},
        {"view_message", {"a.json"}, view_message},
        {"model", {"a.safetensors"}, model},
        {"tensors", {"a.safetensors"}, tensors},
        {"tuning", {"a.json"}, tuning},
        {"shipped_tuning", {"a.json"}, shipped_tuning},
        {"tunables", {"CLVR_TUNE"}, tunables, ErrorKind::usage},
        {"remembered", {"clvr/device.json"}, remembered},
        {"manifest", {"a.json"}, manifest, ErrorKind::internal},
    };
    return targets;
}

const FuzzTarget& fuzz_target(const std::string& name) {
    for (const FuzzTarget& target : fuzz_targets())
        if (target.name == name) return target;
    throw std::out_of_range("no reader " + name);
}

bool read_bytes(const FuzzTarget& target, const std::string& folder, std::string_view bytes) {
    forget_file_roles(); // a run of its own; and libFuzzer looks for leaks only while no input leaves memory behind
    for (std::size_t i = 0; i < target.files.size(); ++i) {
        const fs::path path = fs::path(folder) / target.files[i];
        if (bytes.data() == nullptr) { // the input has no such file
            std::error_code none;
            fs::remove(path, none);
            continue;
        }
        const std::size_t mark = i + 1 < target.files.size() ? bytes.find(file_mark) : std::string_view::npos;
        fs::create_directories(path.parent_path());
        put(path, bytes.substr(0, mark));
        bytes = mark == std::string_view::npos ? std::string_view() : bytes.substr(mark + file_mark.size());
    }
    try {
        target.read((fs::path(folder) / target.files.front()).string());
        return true;
    } catch (const Error& e) {
        check_refusal(e, target.refusal);
        return false;
    }
}

} // namespace clvr::test
