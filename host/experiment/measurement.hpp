// A model and the classical denoisers measured at every noisy frame of a folder of test pairs.
#pragma once
#include "host/eval/report.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// One noisy frame of each view: how many samples per pixel it has, the settings of the classical denoisers chosen for it, the measures.
struct Measurement {
    int spp = 0, frame = 0;
    Baselines baselines;
    Evaluation evaluation;
};

/// The name of the trained network among the candidates.
constexpr const char* trained_candidate = "clvr";

/// How many views the settings of the classical denoisers are chosen on: the best of 3x3 does not change with more.
constexpr int tuning_views = 8;

/// Measures the frames that the file `path` lacks and writes it after each; the classical denoisers are tuned on at most tuning_views of
/// the training pairs. Throws Error{interrupted}.
std::vector<Measurement> measure(const Device& device, const Model& model, const std::string& train_folder, const std::string& test_folder,
                                 const std::vector<int>& spp, const std::string& path, const std::atomic<bool>& interrupted,
                                 const std::function<void(double done, const std::string& note)>& progress);

/// The measurements in the file; none where it is absent. Throws Error{input}.
std::vector<Measurement> read_measurements(const std::string& path, const std::string& test_folder);

/// As parts of a report.
std::vector<ReportPart> report_parts(const Device& device, const Model& model, const std::vector<Measurement>& measurements);

/// Means as Markdown tables, one each of PSNR, SSIM and FLIP: a row a candidate, a column a number of samples per pixel.
std::string markdown_tables(const std::vector<Measurement>& measurements);

} // namespace clvr
