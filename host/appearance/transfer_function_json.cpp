#include "host/appearance/transfer_function_json.hpp"
#include "host/appearance/transfer_function.hpp"
#include "host/frame/srgb.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_fields.hpp"

#include <cmath>
#include <fmt/format.h>

namespace clvr {

using nlohmann::json;

void validate(const TransferFunction& tf, const std::string& where) {
    const auto refuse = [&](std::size_t i, const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("point {}: {}", i, what), where);
    };
    if (tf.points.empty()) throw Error(ErrorKind::input, "the transfer function is empty; expected at least one point", where);
    for (std::size_t i = 0; i < tf.points.size(); ++i) {
        const auto& p = tf.points[i];
        if (!std::isfinite(p.value)) refuse(i, fmt::format("the value {} is not finite", p.value));
        if (i > 0 && p.value < tf.points[i - 1].value)
            refuse(i, fmt::format("the value {} comes after {}; expected ascending values", p.value, tf.points[i - 1].value));
        for (double c : p.color)
            if (!(c >= 0 && c <= 1)) refuse(i, fmt::format("the colour component {} is outside 0..1", c));
        if (!(p.opacity >= 0 && p.opacity <= 1)) refuse(i, fmt::format("the opacity {} is outside 0..1", p.opacity));
    }
}

namespace {

TransferFunction from_design_json(const json& file, const std::string& where) {
    TransferFunction tf;
    tf.name = where;
    JsonFields fields(file, where);
    std::string description;
    bool linear = false;
    fields.get("name", tf.name);
    fields.get("description", description);
    fields.choose<bool>("domain", tf.normalized, {{"physical", false}, {"normalized", true}});
    fields.choose<bool>("color_space", linear, {{"srgb", false}, {"linear", true}});
    const json& points = fields.required("points");
    if (!points.is_array()) fields.fail("points", "a list of points");
    for (std::size_t i = 0; i < points.size(); ++i) {
        JsonFields point(points[i], where, fmt::format("points[{}]", i));
        for (const char* name : {"value", "color", "opacity"}) point.required(name);
        TransferFunction::Point p{};
        point.get("value", p.value);
        point.get("color", p.color);
        point.get("opacity", p.opacity);
        point.done();
        for (double c : p.color)
            if (!(c >= 0 && c <= 1)) point.fail("color", "three numbers in 0..1");
        if (!linear)
            for (double& c : p.color) c = srgb_decode(c);
        tf.points.push_back(p);
    }
    fields.done();
    return tf;
}

} // namespace

TransferFunction parse_transfer_function(const json& file, const std::string& where) {
    const bool paraview = file.is_array() || (file.is_object() && file.contains("RGBPoints"));
    TransferFunction tf = paraview ? from_paraview_json(file, where) : from_design_json(file, where);
    validate(tf, where);
    return tf;
}

TransferFunction parse_transfer_function(const std::string& json_text, const std::string& where) {
    return parse_transfer_function(parse_json(json_text, where), where);
}

std::string to_json(const TransferFunction& tf) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const auto& p : tf.points) points.push_back({{"value", p.value}, {"color", p.color}, {"opacity", p.opacity}});
    const nlohmann::ordered_json file{
        {"name", tf.name}, {"domain", tf.normalized ? "normalized" : "physical"}, {"color_space", "linear"}, {"points", std::move(points)}};
    return file.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace clvr
