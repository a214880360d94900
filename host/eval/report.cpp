#include "host/eval/report.hpp"
#include "host/eval/chart.hpp"
#include "host/frame/error_pictures.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/pairs/folder.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <sstream>

namespace clvr {

namespace {

constexpr int crop_size = 96; // [pixels], shown threefold

constexpr const char* style = R"(
body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 1500px; padding: 0 1em; color: #222; background: #fff }
h1 { font-size: 1.6em } h2 { font-size: 1.2em; margin-top: 2em }
table { border-collapse: collapse; font-variant-numeric: tabular-nums } th, td { padding: .2em .8em; text-align: right; border-bottom: 1px solid #ddd }
th:first-child, td:first-child { text-align: left } td.best { font-weight: 600 }
.row { display: flex; flex-wrap: wrap; gap: 8px } figure { margin: 0 } figcaption { font-size: .85em; color: #555 }
figure img { display: block; background: #000 } img.crop { image-rendering: pixelated; width: 288px; height: 288px }
.chart { width: 560px; height: 300px; font: 11px system-ui, sans-serif } .chart .grid { stroke: #e4e4e4 } .chart .title { font-size: 13px }
.notes { color: #555 } details { margin-top: 1em }
)";

std::string base64(const std::vector<unsigned char>& bytes) {
    std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0'); // EVP_EncodeBlock ends with a 0
    text.resize(static_cast<std::size_t>(
        EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(), static_cast<int>(bytes.size()))));
    return text;
}

/// Part of the picture laid over black.
Frame cut(const Frame& frame, int x, int y, int width, int height) {
    Frame part;
    part.width = std::min(width, frame.width), part.height = std::min(height, frame.height);
    for (const char* c : colour_channels) {
        std::vector<float>& to = part.channel(c);
        for (int j = 0; j < part.height; ++j) {
            const auto row = frame.at(c).begin() + static_cast<std::ptrdiff_t>(y + j) * frame.width + x;
            std::copy(row, row + part.width, to.begin() + static_cast<std::ptrdiff_t>(j) * part.width);
        }
    }
    return part;
}

/// Where a window of the reference has most detail: the sum of |second differences| of its displayed luminance.
std::pair<int, int> most_detailed(const Frame& reference) {
    const int w = std::min(crop_size, reference.width), h = std::min(crop_size, reference.height);
    const float* const rgb[3] = {reference.at("R").data(), reference.at("G").data(), reference.at("B").data()};
    const auto grey = [&](int x, int y) {
        const std::size_t i = static_cast<std::size_t>(y) * reference.width + x;
        double sum = 0;
        for (const float* c : rgb) sum += std::pow(std::clamp(static_cast<double>(c[i]), 0.0, 1.0), 1 / 2.2);
        return sum;
    };
    const int step = std::max(1, crop_size / 6);
    std::pair<int, int> best{0, 0};
    double most = -1;
    for (int y = 0; y + h <= reference.height; y += step)
        for (int x = 0; x + w <= reference.width; x += step) {
            double detail = 0;
            for (int j = y; j + 1 < y + h; j += 2)
                for (int i = x; i + 1 < x + w; i += 2)
                    detail += std::abs(grey(i, j) - grey(i + 1, j)) + std::abs(grey(i, j) - grey(i, j + 1));
            if (detail > most) most = detail, best = {x, y};
        }
    return best;
}

std::string figure(const Frame& picture, const Tonemap& tonemap, const std::string& caption, bool crop) {
    return fmt::format("<figure><img{} alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
                       crop ? " class=\"crop\"" : "", escaped(caption), base64(encode_png(picture, tonemap)), escaped(caption));
}

/// Which way a measure is better: PSNR and SSIM up, the rest down.
bool higher_is_better(const std::string& measure) { return measure.rfind("psnr", 0) == 0 || measure.rfind("ssim", 0) == 0; }

/// Rows of measures; the best of each column stands out.
std::string table(const std::vector<std::pair<std::string, Metrics>>& rows) {
    std::string html = "<table><tr><th></th>";
    for (const auto& [measure, value] : named(rows.front().second)) html += fmt::format("<th>{}</th>", measure);
    html += "</tr>\n";
    for (const auto& [name, metrics] : rows) {
        html += fmt::format("<tr><td>{}</td>", escaped(name));
        const auto values = named(metrics);
        for (std::size_t m = 0; m < values.size(); ++m) {
            bool best = true;
            for (const auto& [other, theirs] : rows) {
                const double v = named(theirs)[m].second;
                best = best && !(higher_is_better(values[m].first) ? v > values[m].second : v < values[m].second);
            }
            html += fmt::format("<td{}>{:.4g}</td>", best ? " class=\"best\"" : "", values[m].second);
        }
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

/// Columns of a CSV with a header line, by name.
std::vector<Series> columns(const std::string& csv) {
    std::vector<Series> all;
    std::istringstream lines(csv);
    std::string line, cell;
    for (bool header = true; std::getline(lines, line); header = false) {
        std::istringstream cells(line);
        for (std::size_t k = 0; std::getline(cells, cell, ','); ++k) {
            if (header)
                all.push_back({cell, {}});
            else if (k < all.size())
                all[k].values.push_back(std::strtod(cell.c_str(), nullptr));
        }
    }
    return all;
}

std::string training_charts(const std::vector<std::pair<std::string, std::string>>& trainings) {
    std::vector<Series> losses, validations;
    for (const auto& [name, csv] : trainings)
        for (const Series& column : columns(csv)) {
            if (column.name == "loss") losses.push_back({name, column.values});
            const bool validated = std::any_of(column.values.begin(), column.values.end(), [](double v) { return v > 0; });
            if (column.name == "validation_psnr" && validated) validations.push_back({name, column.values});
        }
    return line_chart("training loss", "epoch", losses, true) + line_chart("validation PSNR [dB]", "epoch", validations);
}

/// Numbers of the worst, the median and the best view by the PSNR of a score; fewer where there are fewer.
std::vector<std::size_t> telling_views(const Score& score) {
    std::vector<std::size_t> order(score.views.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return score.views[a].psnr < score.views[b].psnr; });
    if (order.size() <= 3) return order;
    return {order.front(), order[order.size() / 2], order.back()};
}

/// A view: pictures, crops and FLIP maps of the first part, then the crops of the others.
std::string view_section(const std::vector<ReportPart>& parts, const PairView& files, std::size_t view, const Tonemap& tonemap) {
    const Frame reference = read_exr(files.reference);
    const auto [x, y] = most_detailed(reference);
    const auto crop_of = [&, x0 = x, y0 = y](const Frame& frame, const std::string& caption) {
        return figure(cut(frame, x0, y0, crop_size, crop_size), tonemap, caption, true);
    };
    std::string pictures, crops, maps, further;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const ReportPart& part = parts[p];
        const Frame noisy = read_exr(files.noisy[static_cast<std::size_t>(part.frame)]);
        std::string row;
        for (std::size_t k = 0; k < part.candidates.size(); ++k) {
            const Frame done = part.candidates[k].denoise(noisy);
            const Metrics& m = part.evaluation.scores[k].views[view];
            const std::string caption = fmt::format("{}: {:.2f} dB, SSIM {:.3f}", part.candidates[k].name, m.psnr, m.ssim);
            row += crop_of(done, caption);
            if (p > 0) continue;
            pictures += figure(cut(done, 0, 0, done.width, done.height), tonemap, caption, false);
            maps +=
                figure(flip_picture(done, reference), {"none", 0}, fmt::format("{}: FLIP {:.4f}", part.candidates[k].name, m.flip), false);
        }
        row += crop_of(reference, "reference");
        if (p == 0)
            crops = row;
        else
            further += fmt::format("<p>{}:</p><div class=\"row\">{}</div>\n", escaped(part.name), row);
    }
    pictures += figure(cut(reference, 0, 0, reference.width, reference.height), tonemap, "reference", false);
    return fmt::format("<h2>{}</h2>\n<div class=\"row\">{}</div>\n<p>At {}, {}, magnified:</p><div class=\"row\">{}</div>\n<p>FLIP (black: "
                       "equal):</p><div class=\"row\">{}</div>\n{}",
                       escaped(std::filesystem::path(parts.front().evaluation.views[view]).filename().string()), pictures, x, y, crops,
                       maps, further);
}

/// Means of a measure: a row a candidate, a column a part; and as curves.
std::string measure_by_part(const std::vector<ReportPart>& parts, double Metrics::*measure, const std::string& name, int digits) {
    std::vector<std::string> names;
    std::string html = fmt::format("<div><h3>{}</h3><table><tr><th></th>", escaped(name));
    for (const ReportPart& part : parts) {
        names.push_back(part.name);
        html += fmt::format("<th>{}</th>", escaped(part.name));
    }
    html += "</tr>\n";
    std::vector<Series> curves;
    for (std::size_t k = 0; k < parts.front().candidates.size(); ++k) {
        curves.push_back({parts.front().candidates[k].name, {}});
        html += fmt::format("<tr><td>{}</td>", escaped(curves.back().name));
        for (const ReportPart& part : parts) {
            curves.back().values.push_back(part.evaluation.scores[k].mean.*measure);
            html += fmt::format("<td>{:.{}f}</td>", curves.back().values.back(), digits);
        }
        html += "</tr>\n";
    }
    return html + "</table>\n" + line_chart(name, "noisy input", curves, false, names) + "</div>\n";
}

void check_parts(const std::vector<ReportPart>& parts, std::size_t views) {
    for (const ReportPart& part : parts)
        if (part.evaluation.scores.size() != part.candidates.size() || part.candidates.empty() || part.evaluation.views.size() != views ||
            part.candidates.size() != parts.front().candidates.size())
            throw Error(ErrorKind::internal, "the report's evaluation is of other candidates or views");
    if (parts.empty()) throw Error(ErrorKind::internal, "a report of nothing");
}

/// Means, and PSNR by view.
std::string part_section(const ReportPart& part, const std::string& beside) {
    std::vector<std::pair<std::string, Metrics>> means;
    std::vector<Series> psnrs;
    for (const Score& s : part.evaluation.scores) {
        means.emplace_back(s.name, s.mean);
        psnrs.push_back({s.name, {}});
        for (const Metrics& m : s.views) psnrs.back().values.push_back(m.psnr);
    }
    return fmt::format("<h2>{}Mean of {} views</h2>\n{}<div class=\"row\">{}{}</div>\n", part.name.empty() ? "" : escaped(part.name) + ": ",
                       part.evaluation.views.size(), table(means), line_chart("PSNR by view [dB]", "view", psnrs), beside);
}

} // namespace

std::string html_report(const std::vector<ReportPart>& parts, const std::string& folder, const ReportOptions& options) {
    const PairsFolder pairs = read_pairs(folder);
    check_parts(parts, pairs.views.size());
    std::string html =
        fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title><style>{1}</style></head>"
                    "<body>\n<h1>{0}</h1>\n<p class=\"notes\">",
                    escaped(options.title), style);
    for (const auto& note : options.notes) html += escaped(note) + "<br>\n";
    html += "</p>\n";
    if (parts.size() > 1)
        html += fmt::format("<h2>Means by noisy input</h2>\n<div class=\"row\">{}{}{}</div>\n",
                            measure_by_part(parts, &Metrics::psnr, "PSNR [dB]", 2), measure_by_part(parts, &Metrics::ssim, "SSIM", 4),
                            measure_by_part(parts, &Metrics::flip, "FLIP", 4));
    for (const ReportPart& part : parts) html += part_section(part, &part == &parts.front() ? training_charts(options.trainings) : "");
    const auto& scores = parts.front().evaluation.scores;
    for (const std::size_t view : telling_views(scores[std::min<std::size_t>(1, scores.size() - 1)]))
        html += view_section(parts, pairs.views[view], view, options.tonemap);
    html += "<details><summary>Every view</summary>\n";
    for (const ReportPart& part : parts)
        for (std::size_t v = 0; v < part.evaluation.views.size(); ++v) {
            std::vector<std::pair<std::string, Metrics>> rows;
            for (const Score& s : part.evaluation.scores) rows.emplace_back(s.name, s.views[v]);
            const std::string file = std::filesystem::path(part.evaluation.views[v]).filename().string();
            html += fmt::format("<h3>{}</h3>\n{}", escaped(part.name.empty() ? file : file + ", " + part.name), table(rows));
        }
    return html + "</details>\n</body></html>\n";
}

} // namespace clvr
