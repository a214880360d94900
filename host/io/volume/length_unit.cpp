#include "host/io/volume/length_unit.hpp"
#include "host/io/volume/header_text.hpp"

#include <map>
#include <string>

namespace clvr {

std::optional<double> millimetres_of(std::string_view unit) {
    static const std::map<std::string, double, std::less<>> symbols{{"km", 1e6},
                                                                    {"m", 1e3},
                                                                    {"dm", 100},
                                                                    {"cm", 10},
                                                                    {"mm", 1},
                                                                    {"um", 1e-3},
                                                                    {"\xc2\xb5m", 1e-3},
                                                                    {"\xce\xbcm", 1e-3},
                                                                    {"\xb5m", 1e-3},
                                                                    {"\\u00B5m", 1e-3},
                                                                    {"\\u00b5m", 1e-3},
                                                                    {"nm", 1e-6},
                                                                    {"pm", 1e-9},
                                                                    {"fm", 1e-12},
                                                                    {"A", 1e-7},
                                                                    {"\xc3\x85", 1e-7},
                                                                    {"\xe2\x84\xab", 1e-7},
                                                                    {"\xc5", 1e-7},
                                                                    {"in", 25.4},
                                                                    {"\"", 25.4},
                                                                    {"ft", 304.8},
                                                                    {"yd", 914.4},
                                                                    {"thou", 0.0254},
                                                                    {"\xc2\xb5", 1e-3},
                                                                    {"\xb5", 1e-3}};
    static const std::map<std::string, double, std::less<>> words{
        {"meter", 1e3},      {"metre", 1e3},       {"centimeter", 10},   {"centimetre", 10},  {"millimeter", 1},   {"millimetre", 1},
        {"micron", 1e-3},    {"micrometer", 1e-3}, {"micrometre", 1e-3}, {"nanometer", 1e-6}, {"nanometre", 1e-6}, {"picometer", 1e-9},
        {"picometre", 1e-9}, {"angstrom", 1e-7},   {"inch", 25.4},       {"inches", 25.4},    {"foot", 304.8},     {"feet", 304.8}};
    unit = trimmed(unit);
    if (const auto symbol = symbols.find(unit); symbol != symbols.end()) return symbol->second;
    std::string word = lower_case(unit);
    for (int plural = 0; plural < 2; ++plural) {
        if (const auto found = words.find(word); found != words.end()) return found->second;
        if (word.empty() || word.back() != 's') break;
        word.pop_back();
    }
    return std::nullopt;
}

} // namespace clvr
