// JSON as clvr prints and writes it, for machines and for people who look.
#pragma once
#include <nlohmann/json.hpp>

#include <string>

namespace clvr {

/// The member of every JSON that clvr reads again: its kind and version, such as "pairs/1".
inline constexpr const char* format_key = "clvr.format";

namespace detail {

template <class Json>
std::string json_on_one_line(const Json& value) {
    if (!value.is_array()) return value.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string text;
    for (const auto& element : value) text += (text.empty() ? "" : ", ") + json_on_one_line(element);
    return "[" + text + "]";
}

/// Whether an array is one line: numbers alone, or a few short words.
template <class Json>
bool is_one_line(const Json& array) {
    constexpr std::size_t widest = 100;
    std::size_t characters = 0;
    for (const auto& element : array) {
        if (element.is_structured()) return false;
        if (element.is_string()) characters += element.template get_ref<const std::string&>().size() + 4;
    }
    return characters <= widest;
}

template <class Json>
void append_json(std::string& text, const Json& value, const std::string& indent) {
    if (!value.is_structured() || value.empty() || (value.is_array() && is_one_line(value))) {
        text += json_on_one_line(value);
        return;
    }
    const bool object = value.is_object();
    text += object ? '{' : '[';
    const char* separator = "\n";
    for (auto it = value.begin(); it != value.end(); ++it) {
        text += separator + indent + "  ";
        if (object) text += json_on_one_line(Json(it.key())) + ": ";
        append_json(text, *it, indent + "  ");
        separator = ",\n";
    }
    text += "\n" + indent + (object ? '}' : ']');
}

} // namespace detail

/// Valid JSON (nlohmann::json or ordered_json) with a newline at its end: each member of an object and each element of an array has its own
/// line, but an array of numbers, however long, is on one line, as is one of a few short words. Bytes that are no UTF-8 are replaced.
template <class Json>
std::string json_text(const Json& value) {
    std::string text;
    detail::append_json(text, value, "");
    return text + "\n";
}

} // namespace clvr
