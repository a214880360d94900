#include "host/experiment/ablation.hpp"

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

std::string heading(const std::vector<std::string>& columns) {
    std::string text = "|", rule = "|";
    for (std::size_t k = 0; k < columns.size(); ++k) {
        text += fmt::format(" {:<{}} |", columns[k], k == 0 ? 44 : 1);
        rule += std::string(std::max<std::size_t>(columns[k].size() + 1, k == 0 ? 46 : 3), '-') + (k == 0 ? "|" : ":|");
    }
    return text + "\n" + rule + "\n";
}

} // namespace

std::string markdown_tables(const std::vector<AblationResult>& results) {
    std::vector<int> spps;
    std::vector<std::string> tests;
    for (const AblationScore& s : results.front().scores) {
        if (spps.empty() || spps.back() != s.spp) spps.push_back(s.spp);
        if (s.spp == spps.front()) tests.push_back(s.test);
    }
    std::vector<std::string> columns{"mean"};
    for (const int spp : spps)
        for (const char* measure : {"PSNR [dB]", "SSIM", "FLIP"}) columns.push_back(fmt::format("{} spp: {}", spp, measure));
    std::string text = heading(columns);
    for (const AblationResult& row : results) {
        text += fmt::format("| {:<44} |", row.title);
        for (const int spp : spps)
            text += fmt::format(" {:.2f} | {:.4f} | {:.4f} |", mean_at(row, spp, &Metrics::psnr), mean_at(row, spp, &Metrics::ssim),
                                mean_at(row, spp, &Metrics::flip));
        text += "\n";
    }
    for (const int spp : spps) {
        columns = {fmt::format("{} spp: PSNR [dB] / SSIM", spp)};
        columns.insert(columns.end(), tests.begin(), tests.end());
        text += "\n" + heading(columns);
        for (const AblationResult& row : results) {
            text += fmt::format("| {:<44} |", row.title);
            for (const AblationScore& s : row.scores)
                if (s.spp == spp) text += fmt::format(" {:.2f} / {:.4f} |", s.mean.psnr, s.mean.ssim);
            text += "\n";
        }
    }
    return text;
}

} // namespace clvr
