// An evaluation as a page to read.
#pragma once
#include "host/eval/evaluation.hpp"
#include "host/frame/tonemap.hpp"

#include <string>
#include <vector>

namespace clvr {

struct ReportOptions {
    std::string title;                                          ///< heading
    std::vector<std::string> notes;                             ///< lines below it: device, model, settings
    Tonemap tonemap;                                            ///< of the pictures
    std::vector<std::pair<std::string, std::string>> trainings; ///< name, CSV of `clvr train` (epoch, loss, validation_psnr)
};

/// An evaluation of a folder at one of its noisy frames.
struct ReportPart {
    std::string name; ///< "4 spp"; may be empty where it is the only one
    int frame = 0;    ///< the noisy frame of each view
    Evaluation evaluation;
    std::vector<Candidate> candidates; ///< of all parts the same names in the same order
};

/// One self-contained HTML page (no scripts, no other files): mean and per-view tables, curves of PSNR by view and of the trainings, and
/// for the worst, the median and the best view of the first model the pictures with 1:1 crops where the reference has most detail, and FLIP
/// maps. Of several parts (noisy frames of other samples per pixel): tables and curves of the means by part, then the tables and curves of
/// each; the three views are chosen by the first part, with the crops of the others below. `folder` is the evaluated one. Throws Error.
std::string html_report(const std::vector<ReportPart>& parts, const std::string& folder, const ReportOptions& options);

} // namespace clvr
