#include "host/experiment/ablation.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace clvr {

namespace {

/// Mean over the tests at some samples per pixel.
double mean_at(const AblationResult& row, int spp, double Metrics::*measure) {
    double sum = 0;
    int n = 0;
    for (const AblationScore& s : row.scores)
        if (s.spp == spp) sum += s.mean.*measure, ++n;
    return sum / n;
}

constexpr std::size_t title_width = 44, cell_width = 16;

std::size_t width_of(const std::string& column) { return std::max(column.size(), cell_width); }

/// A row of cells below the columns, the first of which has the title.
std::string line(const std::string& title, const std::vector<std::string>& cells, const std::vector<std::string>& columns) {
    std::string text = fmt::format("| {:<{}} |", title, title_width);
    for (std::size_t k = 0; k < cells.size(); ++k) text += fmt::format(" {:>{}} |", cells[k], width_of(columns[k]));
    return text + "\n";
}

std::string heading(const std::string& title, const std::vector<std::string>& columns) {
    std::string rule = "|" + std::string(title_width + 2, '-') + "|";
    for (const std::string& column : columns) rule += std::string(width_of(column) + 1, '-') + ":|";
    return line(title, columns, columns) + rule + "\n";
}

} // namespace

std::string markdown_tables(const std::vector<AblationResult>& results) {
    std::vector<int> spps;
    std::vector<std::string> tests;
    for (const AblationScore& s : results.front().scores) {
        if (spps.empty() || spps.back() != s.spp) spps.push_back(s.spp);
        if (s.spp == spps.front()) tests.push_back(s.test);
    }
    std::vector<std::string> columns;
    for (const int spp : spps)
        for (const char* measure : {"PSNR [dB]", "SSIM", "FLIP"}) columns.push_back(fmt::format("{} spp: {}", spp, measure));
    std::string text = heading("mean", columns);
    for (const AblationResult& row : results) {
        std::vector<std::string> cells;
        for (const int spp : spps) {
            cells.push_back(fmt::format("{:.2f}", mean_at(row, spp, &Metrics::psnr)));
            cells.push_back(fmt::format("{:.4f}", mean_at(row, spp, &Metrics::ssim)));
            cells.push_back(fmt::format("{:.4f}", mean_at(row, spp, &Metrics::flip)));
        }
        text += line(row.title, cells, columns);
    }
    for (const int spp : spps) {
        text += "\n" + heading(fmt::format("{} spp: PSNR [dB] / SSIM", spp), tests);
        for (const AblationResult& row : results) {
            std::vector<std::string> cells;
            for (const AblationScore& s : row.scores)
                if (s.spp == spp) cells.push_back(fmt::format("{:.2f} / {:.4f}", s.mean.psnr, s.mean.ssim));
            text += line(row.title, cells, tests);
        }
    }
    return text;
}

} // namespace clvr
