#include "host/experiment/measurement.hpp"
#include "host/eval/evaluation_json.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_text.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace clvr {

using nlohmann::ordered_json;

namespace {

void write_measurements(const std::vector<Measurement>& measurements, const std::string& path) {
    ordered_json frames = ordered_json::array();
    for (const Measurement& m : measurements) {
        ordered_json frame{{"spp", m.spp}, {"frame", m.frame}, {"baselines", to_json(m.baselines)}};
        frame.update(to_json(m.evaluation));
        frames.push_back(frame);
    }
    const std::string text = json_text(ordered_json{{format_key, "evaluation/1"}, {"frames", frames}});
    write_atomically(path, text);
}

} // namespace

std::vector<Measurement> read_measurements(const std::string& path, const std::string& test_folder) {
    std::vector<Measurement> all;
    if (!std::filesystem::exists(path)) return all;
    try {
        const auto j = ordered_json::parse(read_text(path));
        if (j.at(format_key) != "evaluation/1") throw Error(ErrorKind::input, "is of another format; expected evaluation/1", path);
        for (const auto& f : j.at("frames"))
            all.push_back(
                {f.at("spp").get<int>(), f.at("frame").get<int>(), parse_baselines(f.at("baselines")), parse_evaluation(f, test_folder)});
        return all;
    } catch (const nlohmann::json::exception& e) {
        throw Error(ErrorKind::input, fmt::format("is damaged ({}); remove it to measure again", e.what()), path);
    }
}

std::vector<Measurement> measure(const Device& device, const Model& model, const std::string& train_folder, const std::string& test_folder,
                                 const std::vector<int>& spp, const std::string& path, const std::atomic<bool>& interrupted,
                                 const std::function<void(double, const std::string&)>& progress) {
    std::vector<Measurement> all = read_measurements(path, test_folder);
    for (std::size_t frame = all.size(); frame < spp.size(); ++frame) {
        // Half of the time is taken for tuning, half for measuring.
        const auto seen = [&](double half, const std::string& what) {
            return [&, half, what](double done) {
                progress((static_cast<double>(frame) + half + done / 2) / static_cast<double>(spp.size()),
                         fmt::format("{}, {} spp", what, spp[frame]));
                if (interrupted) throw Error(ErrorKind::interrupted, "interrupted; the same command goes on from here");
            };
        };
        Measurement m;
        m.spp = spp[frame];
        m.frame = static_cast<int>(frame);
        m.baselines = best_baselines(device, train_folder, m.frame, seen(0, "classical denoisers' settings"), tuning_views);
        m.evaluation =
            evaluate(candidates(device, {{trained_candidate, model}}, m.baselines), test_folder, m.frame, seen(0.5, "test views"));
        all.push_back(m);
        write_measurements(all, path);
    }
    return all;
}

std::vector<ReportPart> report_parts(const Device& device, const Model& model, const std::vector<Measurement>& measurements) {
    std::vector<ReportPart> parts;
    for (const Measurement& m : measurements)
        parts.push_back(
            {fmt::format("{} spp", m.spp), m.frame, m.evaluation, candidates(device, {{trained_candidate, model}}, m.baselines)});
    return parts;
}

std::string markdown_tables(const std::vector<Measurement>& measurements) {
    struct Column {
        const char* name;
        double Metrics::*measure;
        int digits;
    };
    std::string text;
    for (const Column& c : {Column{"PSNR [dB]", &Metrics::psnr, 2}, {"SSIM", &Metrics::ssim, 4}, {"FLIP", &Metrics::flip, 4}}) {
        text += fmt::format("{}| {:<15} |", text.empty() ? "" : "\n", c.name);
        for (const Measurement& m : measurements) text += fmt::format(" {:>7} |", fmt::format("{} spp", m.spp));
        text += "\n|" + std::string(17, '-') + "|";
        for (std::size_t k = 0; k < measurements.size(); ++k) text += "--------:|";
        text += "\n";
        for (std::size_t s = 0; s < measurements.front().evaluation.scores.size(); ++s) {
            text += fmt::format("| {:<15} |", measurements.front().evaluation.scores[s].name);
            for (const Measurement& m : measurements) text += fmt::format(" {:>7.{}f} |", m.evaluation.scores[s].mean.*c.measure, c.digits);
            text += "\n";
        }
    }
    return text;
}

} // namespace clvr
