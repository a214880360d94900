#include "host/io/volume/length_unit.hpp"
#include "host/io/volume/header_text.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>

namespace clvr {

namespace {

/// "micrometer" from "micrometres": American spelling, singular.
std::string settled(std::string name) {
    if (name.size() > 2 && name.back() == 's') name.pop_back();
    if (name.size() > 5 && name.compare(name.size() - 5, 5, "metre") == 0) name.replace(name.size() - 2, 2, "er");
    return name;
}

} // namespace

std::optional<double> millimetres_of(std::string_view unit) {
    static const std::map<std::string, double, std::less<>> units{
        {"fm", 1e-12},      {"pm", 1e-9},       {"picometer", 1e-9},  {"angstrom", 1e-7},     {"a", 1e-7},         {"\\u00b5m", 1e-3},
        {"\xc3\x85", 1e-7}, {"\xc3\xa5", 1e-7}, {"\xc5", 1e-7},       {"\xe2\x84\xab", 1e-7}, {"nm", 1e-6},        {"nanometer", 1e-6},
        {"um", 1e-3},       {"micron", 1e-3},   {"micrometer", 1e-3}, {"micro-meter", 1e-3},  {"\xc2\xb5m", 1e-3}, {"\xce\xbcm", 1e-3},
        {"\xb5m", 1e-3},    {"\xc2\xb5", 1e-3}, {"\xce\xbc", 1e-3},   {"\xb5", 1e-3},         {"mm", 1},           {"millimeter", 1},
        {"cm", 10},         {"centimeter", 10}, {"dm", 100},          {"decimeter", 100},     {"m", 1000},         {"meter", 1000},
        {"km", 1e6},        {"kilometer", 1e6}, {"in", 25.4},         {"inch", 25.4},         {"inche", 25.4},     {"\"", 25.4},
        {"mil", 0.0254},    {"thou", 0.0254},   {"ft", 304.8},        {"foot", 304.8},        {"feet", 304.8},     {"yd", 914.4},
        {"yard", 914.4}};
    const std::string_view symbol = trimmed(unit);
    if (symbol == "Mm" || symbol == "Pm") return symbol == "Mm" ? 1e9 : 1e18; // the prefixes whose case tells them from milli and pico
    const auto found = units.find(settled(lower_case(symbol)));
    return found == units.end() ? std::nullopt : std::optional(found->second);
}

double unit_or_millimetre(std::string_view unit, std::vector<std::string>& notes) {
    if (trimmed(unit).empty()) return 1;
    const auto found = millimetres_of(unit);
    if (!found) {
        const std::string note = fmt::format("\"{:.40}\" is no unit of length that clvr knows: millimetres are assumed", trimmed(unit));
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
    }
    return found.value_or(1);
}

} // namespace clvr
