#include "runtime/system/json_fields.hpp"
#include "runtime/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace clvr {

using nlohmann::json;

namespace {

constexpr int deepest = 64;

/// The value as the file has it, cut to a length that fits into a message.
std::string excerpt(const json& value) {
    const std::string text =
        value.is_structured() ? (value.is_array() ? "a list" : "an object") : value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 37) + "..." : text;
}

} // namespace

json parse_json(const std::string& text, const std::string& where) {
    std::vector<std::set<std::string>> names; // of the objects that are open
    const auto check = [&](int depth, json::parse_event_t event, json& value) {
        if (depth > deepest) throw Error(ErrorKind::input, fmt::format("is nested deeper than {} levels", deepest), where);
        if (event == json::parse_event_t::object_start) names.emplace_back();
        if (event == json::parse_event_t::object_end) names.pop_back();
        if (event == json::parse_event_t::key && !names.back().insert(value.get<std::string>()).second)
            throw Error(ErrorKind::input, fmt::format("has the member {} twice in one object", excerpt(value)), where);
        return true;
    };
    try {
        return json::parse(text, check);
    } catch (const json::exception& e) {
        const std::string message = e.what();
        const std::size_t tag = message.find("] ");
        throw Error(ErrorKind::input, "is no valid JSON: " + (tag == message.npos ? message : message.substr(tag + 2)), where);
    }
}

JsonFields::JsonFields(const json& object, std::string where, std::string path)
    : object_(&object), where_(std::move(where)), path_(std::move(path)) {
    if (!object.is_object())
        throw Error(ErrorKind::input, fmt::format("{} is {}; expected an object", path_.empty() ? "the file" : path_, excerpt(object)),
                    where_);
}

void JsonFields::fail(const std::string& name, const std::string& expected) const {
    const std::string found = has(name) ? "is " + excerpt((*object_)[name]) : std::string("is missing");
    throw Error(ErrorKind::input, fmt::format("{} {}; expected {}", place(name), found, expected), where_);
}

const json& JsonFields::required(const std::string& name) {
    asked_.insert(name);
    if (!has(name)) throw Error(ErrorKind::input, fmt::format("{} is missing", place(name)), where_);
    return (*object_)[name];
}

JsonFields JsonFields::object(const std::string& name) { return JsonFields(required(name), where_, place(name)); }

void JsonFields::read(const std::string& name, const json& from, double& value) const {
    if (!from.is_number()) fail(name, "numbers");
    value = from.get<double>();
}

void JsonFields::read(const std::string& name, const json& from, int& value) const {
    double number = 0;
    read(name, from, number);
    if (!(number >= -2147483648.0 && number <= 2147483647.0) || number != std::floor(number)) fail(name, "whole numbers");
    value = static_cast<int>(number);
}

void JsonFields::get(const std::string& name, double& value) {
    if (!has(name)) return;
    if (!required(name).is_number()) fail(name, "a number");
    read(name, required(name), value);
}

void JsonFields::get(const std::string& name, int& value) {
    if (!has(name)) return;
    if (!required(name).is_number()) fail(name, "a whole number");
    read(name, required(name), value);
}

void JsonFields::get(const std::string& name, std::uint64_t& value) {
    if (!has(name)) return;
    const json& from = required(name);
    if (!from.is_number_unsigned()) fail(name, "a whole number of 0 or more");
    value = from.get<std::uint64_t>();
}

void JsonFields::get(const std::string& name, bool& value) {
    if (!has(name)) return;
    const json& from = required(name);
    if (!from.is_boolean()) fail(name, "true or false");
    value = from.get<bool>();
}

void JsonFields::get(const std::string& name, std::string& value) {
    if (!has(name)) return;
    const json& from = required(name);
    if (!from.is_string()) fail(name, "a text");
    value = from.get<std::string>();
}

void JsonFields::done() const {
    for (const auto& member : object_->items())
        if (asked_.count(member.key()) == 0)
            throw Error(ErrorKind::input, fmt::format("has the unknown member {}", excerpt(place(member.key()))), where_);
}

} // namespace clvr
