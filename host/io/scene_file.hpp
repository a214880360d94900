// Scene JSON: reads back to the same picture, bit for bit.
#pragma once
#include "host/render/scene.hpp"

#include <string>

namespace clvr {

/// JSON text with every field of the scene (numbers with the digits that read back to the same double), `"clvr.format": "scene/1"`.
std::string to_json(const Scene& scene);
/// Parses a scene; absent fields keep their defaults, unknown fields are errors. Paths inside are relative to the scene file's folder (`where`).
/// Throws Error{input} naming file and field.
Scene parse_scene(const std::string& json_text, const std::string& where);
/// Whether the path or its first bytes say that this is a scene file (JSON with "clvr.format").
bool is_scene_file(const std::string& path);

} // namespace clvr
