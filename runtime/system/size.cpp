#include "runtime/system/size.hpp"

#include "runtime/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace clvr {

std::size_t parse_size(std::string_view text, const std::string& what) {
    // number, factor, unit: each a run of its own characters, blanks between them
    std::size_t at = 0;
    const auto take = [&](const char* characters, std::size_t most) {
        at = std::min(text.find_first_not_of(' ', at), text.size());
        const std::size_t end = std::min({text.find_first_not_of(characters, at), text.size(), at + most});
        std::string taken(text.substr(at, end - at));
        at = end;
        return taken;
    };
    const std::string number = take("0123456789.", 30), factor = take("KMGTkmgt", 1);
    if (!factor.empty()) {
        take("i", 1);
        take("Bb", 1);
    }
    take("", 0);
    double bytes = 0;
    if (at == text.size() && !number.empty() && number.front() != '.' && std::count(number.begin(), number.end(), '.') <= 1) {
        const std::size_t power = factor.empty() ? 0 : std::string_view("KMGTkmgt").find(factor[0]) % 4 + 1;
        bytes = std::floor(std::ldexp(std::stod(number), static_cast<int>(10 * power)));
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
