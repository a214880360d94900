#include "runtime/tune/tuning.hpp"
#include "runtime/system/json_text.hpp"

#include "runtime/error.hpp"
#include "runtime/system/embedded.hpp"
#include "runtime/system/folders.hpp"
#include "runtime/system/hashes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace clvr {
namespace {

constexpr const char* format = "clvr tuning 1";

/// A whole number that an int holds.
bool is_int(const nlohmann::json& value) {
    return value.is_number_integer() && value.get<std::int64_t>() >= std::numeric_limits<int>::min() &&
           value.get<std::int64_t>() <= std::numeric_limits<int>::max() &&
           !(value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{1} << 62);
}

/// The members "tunables" and "evidence" of a file. Throws Error{input}.
Tuning tuning_of(const nlohmann::json& json, const std::string& where) {
    Tuning tuning;
    for (const auto& [name, value] : json.at("tunables").items()) {
        if (!is_int(value)) {
            const std::string found = value.is_number() ? value.dump() : value.type_name(); // a text or a list may have any size and depth
            throw Error(ErrorKind::input, fmt::format("\"{}\" is {}, but must be a whole number", name, found), where);
        }
        if (const std::string why = why_refused(name, value.get<int>()); !why.empty()) throw Error(ErrorKind::input, why, where);
        tuning.values[name] = value.get<int>();
    }
    if (json.contains("evidence"))
        for (const nlohmann::json& line : json.at("evidence")) tuning.evidence.push_back(line.get<std::string>());
    return tuning;
}

/// Calls read(json) on the parsed text and turns what JSON has to complain about into Error{input}.
template <class Read>
auto read_json(const std::string& text, const std::string& where, Read&& read) {
    try {
        return read(nlohmann::json::parse(text));
    } catch (const nlohmann::json::exception&) {
        throw Error(ErrorKind::input, "is no tuning as clvr-bench --tune writes it; delete the file or run clvr-bench --tune", where);
    }
}

std::string joined(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, ", then ")); }

} // namespace

Tunables parse_tunables(const std::string& text, const std::string& where) {
    Tunables tunables;
    std::istringstream items(text);
    for (std::string item; std::getline(items, item, ',');) {
        const std::size_t equals = item.find('=');
        const std::size_t start = equals == std::string::npos ? item.size() : equals + 1;
        char* end = nullptr;
        const long value = std::strtol(item.c_str() + start, &end, 10);
        if (equals == 0 || end == item.c_str() + start || end != item.c_str() + item.size())
            throw Error(ErrorKind::usage, fmt::format("\"{}\" is not name=value with a whole number", item), where);
        const std::string name = item.substr(0, equals);
        constexpr long least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
        const int number = static_cast<int>(std::clamp(value, least, most)); // no tunable may be either
        if (const std::string why = why_refused(name, number); !why.empty()) throw Error(ErrorKind::usage, why, where);
        tunables[name] = number;
    }
    return tunables;
}

Tunables tunables_from_environment() {
    const char* text = std::getenv("CLVR_TUNE");
    return text ? parse_tunables(text, "CLVR_TUNE") : Tunables();
}

Tuning parse_tuning(const std::string& text, const std::string& where) {
    return read_json(text, where, [&](const nlohmann::json& json) {
        if (json.at("format") != format)
            throw Error(ErrorKind::input, fmt::format("is not in the format \"{}\"; run clvr-bench --tune", format), where);
        return tuning_of(json, where);
    });
}

std::optional<std::filesystem::path> tuning_path(const DeviceFacts& d) {
    const auto folder = config_folder();
    if (!folder) return std::nullopt;
    const std::string key = sha256_hex(fmt::format("{}\n{}\n{}\n{}", d.platform, d.platform_version, d.name, d.driver_version));
    return *folder / "tuning" / (key.substr(0, 16) + ".json");
}

std::optional<Tuning> measured_tuning(const DeviceFacts& device) {
    const auto path = tuning_path(device);
    std::error_code none;
    if (!path || !std::filesystem::exists(*path, none)) return std::nullopt;
    try {
        const auto text = load_file(*path);
        if (!text) throw Error(ErrorKind::input, "cannot be read; check its permissions", path->string());
        return parse_tuning(*text, path->string());
    } catch (const Error& error) {
        warn_of_ignored_file(error);
        return std::nullopt;
    }
}

void save_tuning(const DeviceFacts& device, const Tuning& tuning) {
    const auto path = tuning_path(device);
    if (!path) throw Error(ErrorKind::input, "there is no folder to keep the tuning in; set HOME or XDG_CONFIG_HOME");
    const nlohmann::json json{{"format", format},
                              {"platform", device.platform},
                              {"platform_version", device.platform_version},
                              {"device", device.name},
                              {"driver_version", device.driver_version},
                              {"tunables", tuning.values},
                              {"evidence", tuning.evidence}};
    if (!replace_file(*path, json_text(json)))
        throw Error(ErrorKind::input, "cannot be written; check the folder's permissions", path->string());
}

bool ShippedTuning::fits(const DeviceFacts& device) const {
    return !device.simulator && device.platform.find(platform) != std::string::npos && type == type_name(device.type) &&
           (native_float_width == 0 || native_float_width == device.native_float_width);
}

ShippedTuning parse_shipped_tuning(const std::string& text, const std::string& where) {
    return read_json(text, where, [&](const nlohmann::json& json) {
        const nlohmann::json& match = json.at("match");
        if (match.contains("native_float_width") && !match.at("native_float_width").is_number_unsigned())
            throw Error(ErrorKind::input, "\"native_float_width\" is no whole number of 0 or more", where);
        return ShippedTuning{json.at("name"), match.at("platform"), match.at("type"), match.value("native_float_width", 0u),
                             tuning_of(json, where)};
    });
}

std::optional<ShippedTuning> shipped_tuning(const DeviceFacts& device) {
    static const std::vector<ShippedTuning> all = [] {
        std::vector<ShippedTuning> shipped;
        for (const auto& [name, text] : embedded_tuning()) shipped.push_back(parse_shipped_tuning(text, name));
        return shipped;
    }();
    const auto found = std::find_if(all.begin(), all.end(), [&](const ShippedTuning& s) { return s.fits(device); });
    return found == all.end() ? std::nullopt : std::optional(*found);
}

TuningInForce tuning_in_force(const DeviceFacts& device) {
    TuningInForce tuning;
    std::vector<std::string> parts;
    const auto take = [&](const Tunables& values, const std::string& from) {
        tuning.values.insert(values.begin(), values.end());
        parts.push_back(from);
    };
    if (const Tunables asked = tunables_from_environment(); !asked.empty()) take(asked, "the environment's CLVR_TUNE");
    if (const auto measured = measured_tuning(device)) take(measured->values, "measured here by clvr-bench --tune");
    if (const auto shipped = shipped_tuning(device)) take(shipped->tuning.values, "shipped for " + shipped->name);
    tuning.rule = parts.empty() ? "built in, nothing measured yet (clvr-bench --tune)" : joined(parts);
    return tuning;
}

} // namespace clvr
