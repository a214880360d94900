// The options of `clvr render`, as text from the command line to a Scene.
#pragma once
#include "host/cli/device_options.hpp"
#include "host/cli/picture_outputs.hpp"
#include "host/io/volume/volume_file.hpp"
#include "host/render/scene.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace clvr {

/// What the user gave; an option that was not given leaves the scene (its default, or the scene file's value) as it is.
struct RenderOptions {
    std::string input;
    std::vector<std::string> outputs;
    ExrChannels channels;
    VolumeReadOptions volume;
    std::optional<std::string> size, transfer, mode, shading, environment, background, tonemap, clip_box, clip_plane, eye, target;
    std::map<std::string, std::variant<double, int, std::uint64_t, bool>> settings; ///< by the keys of scene_settings()
    bool orthographic = false, list_transfer = false, no_features = false, denoise = false, beside = false;
    double seconds = 0;
    int turntable = 0;
    std::string model = "default", save_scene;
    DeviceOptions devices;
};

inline constexpr int largest_turntable = 10000; ///< views
/// Where a view of a turntable goes: picture_000.png and so on.
std::string view_path(const std::string& path, int view);
/// The files of an output: itself, or with --turntable (`views` above 0) one a view.
std::vector<std::string> view_paths(const std::string& path, int views);

/// The option of a setting, by its key; `help` stands in for the table's.
void add_setting(CLI::App& command, RenderOptions& options, const std::string& key, const std::string& help = {});
/// The options that say what is seen: volume, transfer function, camera, light, size, samples. `device` options too.
void add_scene_options(CLI::App& command, RenderOptions& options);
/// Those and what becomes of the picture.
void add_render_options(CLI::App& command, RenderOptions& options);

/// The scene that the options ask for: that of the scene file when the input is one, else the defaults; then every option that was given.
/// Reads transfer function files. Throws Error{usage} or Error{input} naming the option or file.
Scene scene_of(const RenderOptions& options);

} // namespace clvr
