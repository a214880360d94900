#include "host/eval/chart.hpp"
#include "tools/bench/report.hpp"
#include "tools/bench/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace clvr::bench {
namespace {

constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"}; // M. Okabe, K. Ito

constexpr const char* style = R"(
body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 1180px; padding: 0 1em; color: #222; background: #fff }
h1 { font-size: 1.6em } h2 { font-size: 1.2em; margin: 2em 0 .4em } h3 { font-size: 1em; margin: 1.5em 0 .3em }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .92em } th, td { padding: .15em .8em; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child, td.said, th.said { text-align: left } td.said { color: #555; font-size: .92em } tr.bad td { background: #fdecea }
.notes, figcaption { color: #555 } .row { display: flex; flex-wrap: wrap; gap: 24px; align-items: flex-start } figure { margin: 0 }
svg text { font: 12px system-ui, sans-serif; fill: #222 } svg .small { font-size: 11px; fill: #555 } svg .grid { stroke: #e4e4e4 }
.chosen { background: #eef6fb; border-left: 4px solid #0072b2; padding: .4em 1em; margin: .4em 0 } .key { display: inline-block; width: .8em; height: .8em; margin: 0 .3em 0 1em }
)";

std::string label(const DeviceRows& d) {
    return fmt::format("{}: {}{}", d.facts.index, d.facts.name,
                       d.facts.sub_devices ? fmt::format(" {}/{}", d.facts.sub_device + 1, d.facts.sub_devices) : "");
}

/// Three digits that count, without an exponent.
std::string number_text(double v) {
    if (v < 999.5) return fmt::format("{:.3g}", v);
    const double unit = std::pow(10, std::floor(std::log10(v)) - 2);
    return fmt::format("{:.0f}", std::round(v / unit) * unit);
}

std::string table(const DeviceRows& d) {
    std::string html =
        "<table><tr><th>stage</th><th>time</th><th>spread</th><th>rate</th><th></th><th>of native</th><th>of ceiling</th><th "
        "class=\"said\">status</th></tr>\n";
    const auto percent = [](double share) { return share > 0 ? fmt::format("{:.0f} %", 100 * share) : std::string(); };
    for (const Row& r : d.rows) {
        const bool known = r.status == Status::ok;
        std::string said = status_name(r.status);
        if (!r.reason.empty()) said += ": " + r.reason;
        if (known && !r.note.empty()) said += ", " + r.note;
        html +=
            fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td style=\"text-align:left\">{}</td><td>{}</td><td>{}</td><td "
                        "class=\"said\">{}</td></tr>\n",
                        r.status == Status::wrong_result || r.status == Status::error ? " class=\"bad\"" : "", escaped(r.stage),
                        known ? time_text(r.seconds) : "", known && r.batches > 2 ? fmt::format("{:.1f} %", 100 * r.spread) : "",
                        known ? number_text(r.rate) : "", known ? escaped(r.unit) : "", percent(known ? r.native_share : 0),
                        percent(known ? r.share : 0), escaped(said));
    }
    return html + "</table>\n";
}

/// Bars of one stage, a device each, against the fastest; times count the other way round.
std::string bars(const Report& report, const Stage& stage) {
    double most = 0;
    const auto value = [&](const Row& r) { return stage.unit_items > 0 ? r.rate : 1 / r.rate; };
    for (const DeviceRows& d : report.devices)
        if (const Row* r = d.ok_row(stage.name); r && r->rate > 0 && !d.facts.simulator) most = std::max(most, value(*r));
    if (!(most > 0)) return "";
    constexpr int height = 18, left = 120, full = 260;
    std::string inner;
    int y = 0;
    for (std::size_t i = 0; i < report.devices.size(); ++i) {
        const DeviceRows& d = report.devices[i];
        if (d.facts.simulator) continue;
        const Row* r = d.ok_row(stage.name);
        const double width = r && r->rate > 0 ? std::max(1.0, full * value(*r) / most) : 0;
        inner += fmt::format(
            "<rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/><text class=\"small\" x=\"{:.1f}\" y=\"{}\">{}</text>\n",
            left, y + 2, width, height - 4, colours[i % std::size(colours)], left + width + 5, y + 13,
            r ? number_text(r->rate) + " " + escaped(r->unit) : "no result");
        y += height;
    }
    return fmt::format("<svg viewBox=\"0 0 520 {0}\" width=\"520\" height=\"{0}\" role=\"img\"><text x=\"{1}\" y=\"13\" "
                       "text-anchor=\"end\">{2}</text>\n{3}</svg>\n",
                       y, left - 8, escaped(stage.name), inner);
}

/// What a single device reaches of its own ceilings: those as numbers, and a bar for each stage that is held against one.
std::string ceilings(const DeviceRows& d) {
    std::string known;
    for (const char* stage : {"FMA rate", "copy", "triad"})
        if (const Row* r = d.ok_row(stage))
            known += fmt::format("{}{} {} {}", known.empty() ? "" : ", ", stage, number_text(r->rate), escaped(r->unit));
    constexpr int height = 20, left = 130, full = 400;
    std::string inner;
    int y = 0;
    for (const Row& r : d.rows) {
        if (r.status != Status::ok || !(r.share > 0)) continue;
        const Ceiling ceiling = stage_named(r.stage).ceiling;
        inner += fmt::format(
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" "
            "fill=\"#e4e4e4\"/><rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/><text class=\"small\" x=\"{}\" "
            "y=\"{}\">{:.0f} % of {}: {} {}</text>\n",
            left - 8, y + 14, escaped(r.stage), left, y + 3, full, height - 6, left, y + 3, std::max(1.0, full * std::min(r.share, 1.0)),
            height - 6, colours[0], left + full + 8, y + 14, 100 * r.share, ceiling == Ceiling::arithmetic ? "FMA rate" : "bandwidth",
            number_text(r.rate), escaped(r.unit));
        y += height;
    }
    if (inner.empty()) return "";
    return fmt::format(
        "<p class=\"notes\">{0}: {1}.</p>\n<svg viewBox=\"0 0 780 {2}\" width=\"780\" height=\"{2}\" role=\"img\">\n{3}</svg>\n",
        escaped(label(d)), known, y, inner);
}

std::string legend(const Report& report) {
    std::string html;
    for (std::size_t i = 0; i < report.devices.size(); ++i)
        if (!report.devices[i].facts.simulator)
            html += fmt::format("<span class=\"key\" style=\"background:{}\"></span>{}", colours[i % std::size(colours)],
                                escaped(label(report.devices[i])));
    return fmt::format("<p class=\"notes\">{}</p>\n", html);
}

/// A rectangle on the picture.
struct Box {
    double x0, y0, x1, y1;
    bool meets(const Box& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

/// Finds each label a place where nothing else stands.
class Labels {
public:
    /// Labels stay inside `picture`.
    explicit Labels(const Box& picture) : picture_(picture) {}
    void keep_free(const Box& box) { taken_.push_back(box); }
    /// Text for the mark at (x, y): beside it or, step by step, farther below and above; then with a line to it.
    std::string place(const std::string& text, double x, double y) {
        const double width = 6.8 * static_cast<double>(text.size());
        constexpr double height = 14, gap = 9;
        for (int step = 0; step < 40; ++step)
            for (const double sign : {1.0, -1.0})
                for (const bool right : {true, false}) {
                    const double middle = y + sign * (step == 0 ? 0 : 4 + 8 * step);
                    const double from = right ? x + gap : x - gap - width;
                    const Box box{from, middle - height / 2, from + width, middle + height / 2};
                    if (!inside(box) || std::any_of(taken_.begin(), taken_.end(), [&](const Box& t) { return t.meets(box); })) continue;
                    taken_.push_back(box);
                    std::string svg;
                    if (step > 1)
                        svg = fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#aaa\"/>", x, y,
                                          right ? from - 2 : from + width + 2, middle);
                    return svg + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", right ? from : from + width,
                                             middle + 4, right ? "start" : "end", escaped(text));
                }
        return ""; // a picture that is full
    }

private:
    bool inside(const Box& b) const { return b.x0 >= picture_.x0 && b.x1 <= picture_.x1 && b.y0 >= picture_.y0 && b.y1 <= picture_.y1; }
    Box picture_;
    std::vector<Box> taken_;
};

} // namespace

std::string roofline_svg(const DeviceRows& d) {
    const Row *fma = d.ok_row("FMA rate"), *copy = d.ok_row("copy"), *triad = d.ok_row("triad");
    const double peak = fma ? fma->flops : 0, bytes = std::max(copy ? copy->bytes : 0, triad ? triad->bytes : 0);
    if (!(peak > 0) || !(bytes > 0)) return "";
    std::vector<const Row*> points;
    for (const Row& r : d.rows)
        if (r.status == Status::ok && r.intensity > 0 && r.flops > 0 && r.stage != "triad") points.push_back(&r);
    // Both axes are logarithmic: whole decades around ridge, points and peak.
    double low_x = peak / bytes, high_x = low_x, low_y = peak;
    for (const Row* r : points)
        low_x = std::min(low_x, r->intensity), high_x = std::max(high_x, r->intensity), low_y = std::min(low_y, r->flops);
    const double x0 = std::floor(std::log10(low_x) - 0.3), x1 = std::ceil(std::log10(high_x) + 0.3);
    const double y0 = std::floor(std::log10(std::min(low_y, bytes * std::pow(10, x0))) + 0.01), y1 = std::ceil(std::log10(peak) + 0.1);
    constexpr double left = 64, right = 540, top = 26, bottom = 276;
    const auto x = [&](double v) { return left + (std::log10(v) - x0) / (x1 - x0) * (right - left); };
    const auto y = [&](double v) { return bottom + (std::log10(v) - y0) / (y1 - y0) * (top - bottom); };
    std::string svg =
        fmt::format("<svg viewBox=\"0 0 620 320\" width=\"620\" height=\"320\" role=\"img\"><text x=\"{}\" y=\"14\">{}</text>\n", left,
                    escaped(label(d)));
    for (double e = x0; e <= x1; ++e)
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text class=\"small\" x=\"{0:.1f}\" y=\"{3}\" "
            "text-anchor=\"middle\">{4:g}</text>\n",
            x(std::pow(10, e)), top, bottom, bottom + 16, std::pow(10, e));
    for (double e = y0; e <= y1; ++e)
        svg += fmt::format(
            "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/><text class=\"small\" x=\"{3}\" y=\"{4:.1f}\" "
            "text-anchor=\"end\">{5:g}</text>\n",
            left, right, y(std::pow(10, e)), left - 6, y(std::pow(10, e)) + 4, std::pow(10, e - 9));
    const double start = std::pow(10, x0), ridge = peak / bytes, end = std::pow(10, x1);
    const double start_y = std::max(bytes * start, std::pow(10, y0)), start_x = start_y / bytes;
    svg +=
        fmt::format("<polyline fill=\"none\" stroke=\"#444\" stroke-width=\"2\" points=\"{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}\"/>\n",
                    x(start_x), y(start_y), x(ridge), y(peak), x(end), y(peak));
    svg += fmt::format("<text class=\"small\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">FMA rate {} GFLOP/s</text>\n", right,
                       y(peak) - 6, number_text(peak * 1e-9));
    svg += fmt::format("<text class=\"small\" x=\"{:.1f}\" y=\"{:.1f}\">{} GB/s</text>\n", x(start_x) + 24,
                       std::min(y(start_y) + 2, bottom - 4), number_text(bytes * 1e-9));
    Labels labels({left + 2, top, 618, bottom - 2});
    labels.keep_free({right - 170, y(peak) - 20, right, y(peak) + 2});                      // "FMA rate ..."
    labels.keep_free({x(start_x) + 20, y(start_y) - 12, x(start_x) + 100, y(start_y) + 6}); // "... GB/s"
    for (const Row* r : points) labels.keep_free({x(r->intensity) - 6, y(r->flops) - 6, x(r->intensity) + 6, y(r->flops) + 6});
    std::string marks, texts;
    int k = 0;
    for (const Row* r : points) {
        const double roof = std::min(peak, bytes * r->intensity);
        const char* colour = colours[k++ % static_cast<int>(std::size(colours))];
        marks += fmt::format(
            "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"5\" fill=\"{2}\"/><line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{3:.1f}\" "
            "stroke=\"{2}\" stroke-dasharray=\"2 3\"/>\n",
            x(r->intensity), y(r->flops), colour, y(roof));
        texts += labels.place(fmt::format("{} {:.0f} %", r->stage, 100 * r->flops / roof), x(r->intensity), y(r->flops));
    }
    svg += marks + texts; // texts over the lines
    return svg + fmt::format("<text class=\"small\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">floating-point operations a byte</text><text "
                             "class=\"small\" "
                             "x=\"12\" y=\"{}\" transform=\"rotate(-90 12 {})\" text-anchor=\"middle\">GFLOP/s</text></svg>\n",
                             (left + right) / 2, bottom + 36, (top + bottom) / 2, (top + bottom) / 2);
}

std::string report_html(const Report& report) {
    std::string html = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>clvr-bench</title><style>{}</style></head>"
        "<body>\n<h1>clvr-bench: what this machine's devices do</h1>\n<p class=\"notes\">clvr {}{}. Medians of calibrated batches; "
        "spread: half the interquartile range. Every row was checked against golden results.</p>\n",
        style, CLVR_VERSION, report.quick ? ", measured quickly" : "");
    for (const Recommendation& r : report.recommendations) {
        std::string names;
        for (const std::size_t d : r.devices) names += (names.empty() ? "" : " and ") + escaped(label(report.devices[d]));
        html += fmt::format("<div class=\"chosen\"><b>{}</b>: {}{}.</div>\n", r.task, names.empty() ? "" : names + ": ", escaped(r.reason));
    }
    std::vector<const DeviceRows*> real;
    for (const DeviceRows& d : report.devices)
        if (!d.facts.simulator) real.push_back(&d);
    if (real.size() == 1)
        html += "<h2>Share of the device's ceilings</h2>\n" + ceilings(*real.front());
    else {
        html += "<h2>Speed by stage</h2>\n" + legend(report) + "<div class=\"row\">";
        for (const Stage& stage : stages()) html += bars(report, stage);
        html += "</div>\n";
    }
    html += "<h2>Against each device's own roofline</h2>\n<p class=\"notes\">A stage lies below the roof that its arithmetic a "
            "byte allows; the "
            "number is its share of that.</p><div class=\"row\">";
    for (const DeviceRows& d : report.devices)
        if (!d.facts.simulator) html += roofline_svg(d);
    html += "</div>\n<h2>All numbers</h2>\n";
    for (std::size_t i = 0; i < report.devices.size(); ++i) {
        const DeviceRows& d = report.devices[i];
        html +=
            fmt::format("<h3>{}</h3><p class=\"notes\">{}, {}, driver {}; tuning: {}</p>\n{}", escaped(label(d)), type_name(d.facts.type),
                        escaped(d.facts.platform), escaped(d.facts.driver_version), escaped(d.tuning), table(d));
        const auto tuned = report.tuned.find(i);
        if (tuned == report.tuned.end()) continue;
        html += fmt::format("<details><summary>Tuning: {} candidates tried, {} refused</summary><ul>\n", tuned->second.tried,
                            tuned->second.refused);
        for (const std::string& line : tuned->second.tuning.evidence) html += fmt::format("<li>{}</li>\n", escaped(line));
        html += "</ul></details>\n";
    }
    return html + "</body></html>\n";
}

} // namespace clvr::bench
