#include "host/io/model/model_file.hpp"
#include "host/io/model/embedded_models.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_fields.hpp"
#include "runtime/system/json_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clvr {
using nlohmann::json;

namespace {

constexpr const char* model_tag = "model/1";
const char* const settings_key = "clvr.model";

/// The tensor's floats and shape, which must have so many dimensions.
std::vector<float> floats_of(const TensorFile& file, const std::string& name, std::size_t dimensions, std::vector<std::int64_t>& shape) {
    const Tensor& t = file.at(name);
    if (t.type != "F32") throw Error(ErrorKind::input, fmt::format("tensor {} is of type {}; expected F32", name, t.type));
    if (t.shape.size() != dimensions)
        throw Error(ErrorKind::input,
                    fmt::format("tensor {} has the shape [{}]; expected {} dimensions", name, fmt::join(t.shape, ", "), dimensions));
    shape = t.shape;
    return t.floats();
}

void expect_shape(const char* name, const std::vector<std::int64_t>& shape, const std::vector<std::int64_t>& expected) {
    if (shape != expected)
        throw Error(ErrorKind::input,
                    fmt::format("tensor {} has the shape [{}]; expected [{}]", name, fmt::join(shape, ", "), fmt::join(expected, ", ")));
}

void read_settings(const std::string& text, const std::string& where, Model& m) {
    const json settings = parse_json(text, where + ": " + settings_key);
    JsonFields fields(settings, where);
    const json& channels = fields.required("channels");
    if (!channels.is_array()) fields.fail("channels", "a list of names");
    for (const auto& c : channels) {
        if (!c.is_string()) fields.fail("channels", "a list of names");
        m.channels.push_back(c.get<std::string>());
    }
    const json& levels = fields.required("levels");
    if (!levels.is_array()) fields.fail("levels", "a list of [pixels, codes]");
    m.levels.clear();
    for (const auto& l : levels) {
        if (!l.is_array() || l.size() != 2 || !l[0].is_number_integer() || !l[1].is_number_integer())
            fields.fail("levels", "a list of [pixels, codes]");
        const auto pixels = l[0].get<std::int64_t>(), codes = l[1].get<std::int64_t>();
        if (pixels < 1 || pixels > 64 || codes < 4 || codes > 256) fields.fail("levels", "1 to 64 pixels, 4 to 256 codes");
        m.levels.push_back({static_cast<int>(pixels), static_cast<int>(codes)});
    }
    fields.get("exposure", m.exposure);
    double floor = m.albedo_floor;
    fields.get("albedo_floor", floor);
    m.albedo_floor = static_cast<float>(floor);
    fields.get("opacity_weight", m.opacity_weight);
    fields.get("demodulation", m.demodulation);
    fields.get("control_variate", m.control_variate);
    fields.get("control_variate_cell", m.control_variate_cell);
    fields.done();
}

} // namespace

Model model_of(const TensorFile& file, const std::string& where) {
    Model m;
    try {
        std::vector<std::int64_t> shape1, bias1, shape2, bias2;
        m.conv1_weight = floats_of(file, "conv1.weight", 4, shape1);
        m.conv1_bias = floats_of(file, "conv1.bias", 1, bias1);
        m.conv2_weight = floats_of(file, "conv2.weight", 4, shape2);
        m.conv2_bias = floats_of(file, "conv2.bias", 1, bias2);
        const auto format = file.metadata.find(format_key);
        const auto settings = file.metadata.find(settings_key);
        if (format != file.metadata.end() && format->second != model_tag)
            throw Error(ErrorKind::input, fmt::format("{} is \"{}\"; this clvr reads {}", format_key, format->second, model_tag));
        if (settings != file.metadata.end())
            read_settings(settings->second, where, m);
        else if (shape1[1] == 10)
            m.channels = reference_channels();
        else
            throw Error(ErrorKind::input,
                        fmt::format("has {} input channels and no metadata {} that names them (10 would mean the reference's)", shape1[1],
                                    settings_key));
        if (shape1[0] < 1 || shape1[0] > 256 || shape1[2] < 1 || shape1[2] > 15)
            throw Error(ErrorKind::input,
                        fmt::format("tensor conv1.weight has the shape [{}]; expected 1 to 256 hidden channels, a kernel of 1 to 15",
                                    fmt::join(shape1, ", ")));
        m.hidden = static_cast<int>(shape1[0]);
        m.kernel = static_cast<int>(shape1[2]);
        expect_shape("conv1.weight", shape1, {m.hidden, static_cast<std::int64_t>(m.channels.size()), m.kernel, m.kernel});
        expect_shape("conv1.bias", bias1, {m.hidden});
        expect_shape("conv2.weight", shape2, {m.outputs(), m.hidden, m.kernel, m.kernel});
        expect_shape("conv2.bias", bias2, {m.outputs()});
        for (const auto& [key, value] : file.metadata)
            if (key != format_key && key != settings_key) m.notes[key] = value;
        validate(m);
    } catch (const Error& e) {
        const std::string line = e.line(), prefix = where + ": ";
        throw Error(ErrorKind::input, line.rfind(prefix, 0) == 0 ? line.substr(prefix.size()) : line, where);
    }
    return m;
}

std::string model_settings_json(const Model& m) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const auto& level : m.levels) levels.push_back({level.pixels, level.codes});
    nlohmann::ordered_json settings{{"channels", m.channels},
                                    {"levels", levels},
                                    {"exposure", m.exposure},
                                    {"albedo_floor", static_cast<double>(m.albedo_floor)},
                                    {"opacity_weight", m.opacity_weight}};
    // Left out where they have the default: such files have the same bytes as before these switches existed.
    if (!m.demodulation) settings["demodulation"] = false;
    if (m.control_variate) settings["control_variate"] = true;
    if (m.control_variate_cell) settings["control_variate_cell"] = m.control_variate_cell;
    return settings.dump();
}

TensorFile tensors_of(const Model& m) {
    TensorFile file;
    const std::int64_t in = static_cast<std::int64_t>(m.channels.size()), k = m.kernel;
    file.tensors = {{"conv1.weight", float_tensor({m.hidden, in, k, k}, m.conv1_weight)},
                    {"conv1.bias", float_tensor({m.hidden}, m.conv1_bias)},
                    {"conv2.weight", float_tensor({m.outputs(), m.hidden, k, k}, m.conv2_weight)},
                    {"conv2.bias", float_tensor({m.outputs()}, m.conv2_bias)}};
    file.metadata = m.notes;
    file.metadata[format_key] = model_tag;
    file.metadata[settings_key] = model_settings_json(m);
    return file;
}

std::vector<std::string> embedded_model_names() {
    std::vector<std::pair<std::size_t, std::string>> models; // channels, name
    for (const auto& [file, bytes] : embedded_models()) {
        const std::string name = file.substr(0, file.rfind('.'));
        models.emplace_back(model_of(parse_tensors(bytes, name), name).channels.size(), name);
    }
    std::sort(models.rbegin(), models.rend());
    std::vector<std::string> names;
    for (const auto& [channels, name] : models) names.push_back(name);
    return names;
}

Model read_model(const std::string& path) {
    std::error_code failed;
    const auto found = embedded_models().find(path + ".safetensors");
    if (found != embedded_models().end() && !std::filesystem::is_regular_file(path, failed))
        return model_of(parse_tensors(found->second, path), path);
    if (path == "default" && !std::filesystem::exists(path, failed))
        throw Error(ErrorKind::usage, "is not inside this build: add --model FILE, as `clvr train` writes it", "the default model");
    return model_of(read_tensors(path), path);
}
void write_model(const Model& model, const std::string& path) { write_tensors(tensors_of(model), path); }

} // namespace clvr
