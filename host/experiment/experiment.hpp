// An experiment from nothing to a report, in stages: a run that was interrupted continues at the next start.
#pragma once
#include "host/experiment/experiment_settings.hpp"
#include "runtime/opencl/device.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// Who made results.
struct Provenance {
    std::string version, commit, command; ///< commit: empty where it is not known
};

struct ExperimentControl {
    const std::atomic<bool>& interrupted;
    /// A stage ("training", ...), its share done 0..1, a note.
    std::function<void(const std::string& stage, double done, const std::string& note)> progress;
};

/// What an experiment's folder says.
struct ExperimentOutcome {
    bool changed = false; ///< whether anything was left to do
    std::string table;    ///< Markdown: means by samples per pixel
};

/// Makes whatever the folder still lacks of these files: experiment.json (the settings), volume.nii (computed volumes), train/ and test/
/// (as `clvr pairs` makes them), model.safetensors and what `clvr train` leaves beside it, evaluation.json (every view), results.json and
/// results.md (means, device, seconds), report.html, and stages.json (seconds of each stage). results.* and stages.json hold times; all
/// others depend on the settings and the training device alone, however often the run was interrupted. Renders on all devices, trains on
/// the first. Throws Error{input}: the folder cannot be made or belongs to another experiment; Error{interrupted}.
ExperimentOutcome run_experiment(const ExperimentSettings& settings, const std::string& folder, std::vector<Device> devices,
                                 const Provenance& provenance, const ExperimentControl& control);

/// The experiment's volume: made into DIR/volume.nii and read from there, or the given file. Throws Error{interrupted}.
Voxels experiment_volume(const ExperimentSettings& settings, const std::string& folder, Device& device,
                         const std::atomic<bool>& interrupted);

/// The files that an experiment writes more than once, or without looking whether they exist.
std::vector<std::string> experiment_files(const std::string& folder);

} // namespace clvr
