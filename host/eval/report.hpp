// An evaluation as a page to read.
#pragma once
#include "host/eval/evaluation.hpp"
#include "host/frame/tonemap.hpp"

#include <string>
#include <vector>

namespace clvr {

struct ReportOptions {
    int frame = 0;                                              ///< the noisy frame of each view that was evaluated
    std::string title;                                          ///< heading
    std::vector<std::string> notes;                             ///< lines below it: device, model, settings
    Tonemap tonemap;                                            ///< of the pictures
    std::vector<std::pair<std::string, std::string>> trainings; ///< name, CSV of `clvr train` (epoch, loss, validation_psnr)
};

/// One self-contained HTML page (no scripts, no other files): mean and per-view tables, curves of PSNR by view and of the trainings, and
/// for the worst, the median and the best view of the first model the pictures with 1:1 crops where the reference has most detail, and FLIP
/// maps. `folder` is the evaluated one. Throws Error.
std::string html_report(const Evaluation& evaluation, const std::vector<Candidate>& candidates, const std::string& folder,
                        const ReportOptions& options);

} // namespace clvr
