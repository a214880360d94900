#include "runtime/size.hpp"

#include "runtime/error.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <regex>

namespace clvr {

std::size_t parse_size(std::string_view text, const std::string& what) {
    static const std::regex form(R"(\s*([0-9]{1,19}(?:\.[0-9]{1,9})?)\s*(?:([KMGT])(?:i?B)?)?\s*)", std::regex::icase);
    std::match_results<std::string_view::const_iterator> match;
    double bytes = 0;
    if (std::regex_match(text.begin(), text.end(), match, form)) {
        const std::string letter = match[2].str();
        const std::size_t power = letter.empty() ? 0 : std::string_view("KMGTkmgt").find(letter[0]) % 4 + 1;
        bytes = std::floor(std::ldexp(std::stod(match[1].str()), static_cast<int>(10 * power)));
    }
    if (!(bytes >= 1 && bytes < 0x1p60))
        throw Error(ErrorKind::usage, fmt::format("\"{}\" is not a size; write bytes, or a number with K, M or G, such as 512M", text),
                    what);
    return static_cast<std::size_t>(bytes);
}

std::optional<std::size_t> size_from_environment(const char* variable) {
    const char* text = std::getenv(variable);
    if (!text || !*text) return std::nullopt;
    return parse_size(text, variable);
}

std::string size_text(std::size_t bytes) {
    static constexpr std::array<const char*, 5> units{"bytes", "KiB", "MiB", "GiB", "TiB"};
    std::size_t unit = 0;
    double value = static_cast<double>(bytes);
    while (value >= 1024 && unit + 1 < units.size()) {
        value /= 1024;
        ++unit;
    }
    return unit == 0 || value >= 100 ? fmt::format("{:.0f} {}", value, units[unit]) : fmt::format("{:.1f} {}", value, units[unit]);
}

} // namespace clvr
