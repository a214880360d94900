#include "host/eval/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace clvr {

namespace {

constexpr double width = 560, left = 56, right = 548, top = 28, bottom = 236;
constexpr double character = 6.5; // a wide guess of a letter's width, in units: what SVG text takes is not known here
constexpr std::array<const char*, 6> colours{"#999999", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"}; // M. Okabe, K. Ito

struct Axis {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    bool logarithmic = false;

    double share(double v) const { return logarithmic ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low); }
    double y(double v) const { return bottom + share(v) * (top - bottom); }

    void include(double v) { low = std::min(low, v), high = std::max(high, v); }
    /// Some room, and never a width of 0.
    void widen() {
        if (logarithmic) {
            low /= 1.1, high *= 1.1;
            return;
        }
        const double room = high > low ? 0.05 * (high - low) : std::max(std::abs(high) * 0.05, 1e-9);
        low -= room, high += room;
    }
    /// 3 to 8 round numbers within.
    std::vector<double> ticks() const {
        std::vector<double> at;
        if (logarithmic && high / low > 8) {
            for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10)
                for (const double k : {1.0, 2.0, 5.0})
                    if (k * decade >= low && k * decade <= high) at.push_back(k * decade);
            return at;
        }
        const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough))), part = rough / power;
        const double step = power * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10);
        for (double v = std::ceil(low / step); v * step <= high; v += 1) at.push_back(v * step + 0.0); // never -0
        return at;
    }
};

/// Letters of a text in UTF-8.
std::size_t letters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

/// The middle of a label that is to stand at x, moved so that all of it is on the picture.
double middle_of(const std::string& label, double x) {
    const double half = static_cast<double>(letters(label)) * character / 2;
    return std::max(half, std::min(x, width - half));
}

/// A text cut to so many units, with an ellipsis where it was longer.
std::string fitted(const std::string& text, double units) {
    const auto most = static_cast<std::size_t>(std::max(2.0, units / character));
    if (letters(text) <= most) return text;
    std::size_t end = 0;
    for (std::size_t n = 0; end < text.size(); ++end)
        if ((text[end] & 0xc0) != 0x80 && ++n == most) break; // the first byte of the letter that the ellipsis replaces
    return text.substr(0, end) + "\u2026";
}

} // namespace

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string line_chart(const std::string& title, const std::string& x_label, const std::vector<Series>& series, bool logarithmic,
                       const std::vector<std::string>& x_names) {
    Axis axis;
    std::size_t count = 0;
    for (const Series& s : series) {
        count = std::max(count, s.values.size());
        for (const double v : s.values)
            if (std::isfinite(v)) axis.include(v);
    }
    if (!(axis.low <= axis.high)) return "";
    axis.logarithmic = logarithmic && axis.low > 0;
    axis.widen();
    const auto x = [&](std::size_t k) {
        return count > 1 ? left + (right - left) * static_cast<double>(k) / static_cast<double>(count - 1) : (left + right) / 2;
    };

    std::string svg =
        fmt::format("<svg viewBox=\"0 0 560 300\" class=\"chart\" role=\"img\"><text x=\"{}\" y=\"16\" class=\"title\">{}</text>\n", left,
                    escaped(title));
    for (const double v : axis.ticks())
        svg += fmt::format("<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" class=\"grid\"/><text x=\"{3}\" y=\"{4:.1f}\" "
                           "text-anchor=\"end\">{5:.4g}</text>\n",
                           left, right, axis.y(v), left - 6, axis.y(v) + 4, v);
    const std::size_t every = std::max<std::size_t>(1, (count + 9) / 10);
    for (std::size_t k = 0; k < count; k += every) {
        const std::string name = k < x_names.size() ? x_names[k] : std::to_string(k + 1);
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", middle_of(name, x(k)), bottom + 16,
                           escaped(name));
    }
    svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + right) / 2, bottom + 32, escaped(x_label));
    for (std::size_t s = 0; s < series.size(); ++s) {
        const char* colour = colours[s % colours.size()];
        std::string points;
        for (std::size_t k = 0; k < series[s].values.size(); ++k) {
            const double v = series[s].values[k];
            if (!std::isfinite(v)) continue;
            points += fmt::format("{:.1f},{:.1f} ", x(k), axis.y(v));
            if (count <= 40) svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"{}\"/>\n", x(k), axis.y(v), colour);
        }
        svg += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n", points, colour);
        const double share = (right - left) / static_cast<double>(series.size()), at = left + static_cast<double>(s) * share;
        svg +=
            fmt::format("<rect x=\"{0:.1f}\" y=\"288\" width=\"10\" height=\"3\" fill=\"{1}\"/><text x=\"{2:.1f}\" y=\"294\">{3}</text>\n",
                        at, colour, at + 14, escaped(fitted(series[s].name, share - 18)));
    }
    return svg + "</svg>\n";
}

} // namespace clvr
