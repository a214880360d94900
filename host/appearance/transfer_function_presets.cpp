#include "host/appearance/embedded_presets.hpp"
#include "host/appearance/transfer_function_json.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_fields.hpp"

#include <fmt/format.h>

namespace clvr {

std::vector<Preset> transfer_presets() {
    std::vector<Preset> presets;
    for (const auto& [file, text] : embedded_presets()) {
        Preset preset;
        const nlohmann::json content = parse_json(text, file);
        JsonFields fields(content, file);
        fields.get("name", preset.name);
        fields.get("description", preset.description);
        presets.push_back(preset);
    }
    return presets;
}

TransferFunction transfer_preset(const std::string& name) {
    if (const auto found = embedded_presets().find(name + ".json"); found != embedded_presets().end())
        return parse_transfer_function(found->second, found->first);
    std::string names;
    for (const Preset& preset : transfer_presets()) names += (names.empty() ? "" : ", ") + preset.name;
    throw Error(ErrorKind::usage, fmt::format("there is neither a file nor a preset '{}'; the presets are {}", name, names), "--tf");
}

} // namespace clvr
