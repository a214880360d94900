// Scene JSON: reads back to the same picture, bit for bit.
#pragma once
#include "host/render/scene.hpp"

#include <string>

namespace clvr {

/// JSON text with every field of the scene (numbers with the digits that read back to the same double), `"clvr.format": "scene/1"`. The
/// scene is valid; its paths are written as they are.
std::string to_json(const Scene& scene);
/// The same without the folders of its files: what a frame says of its scene, the same wherever it was rendered.
std::string provenance_json(const Scene& scene);
/// Parses and validates a scene; absent fields keep their defaults, unknown fields are errors. Paths inside are relative to the folder of
/// the scene file `where`, and come out relative to the working directory (or absolute). Throws Error{input} naming file and field.
Scene parse_scene(const std::string& json_text, const std::string& where);

/// Reads a scene file. Throws Error{input}.
Scene read_scene(const std::string& path);
/// Writes a scene file whose paths are relative to its own folder, so that it can be read from any working directory. Throws Error{input}.
void write_scene(const Scene& scene, const std::string& path);
/// Whether the first bytes say that this is a scene file (a JSON object with "clvr.format").
bool is_scene_file(const std::string& path);

} // namespace clvr
