// What an experiment will take.
#pragma once
#include "host/experiment/experiment.hpp"

namespace clvr {

/// One stage of the plan.
struct StageEstimate {
    std::string name;
    double seconds = 0;
    std::size_t disk_bytes = 0; ///< at most: EXR files are compressed
    double paths = 0;
    std::int64_t steps = 0; ///< of training
};

struct ExperimentEstimate {
    std::vector<StageEstimate> stages;
    Int3 dims{}; ///< of the volume
    VoxelType type = VoxelType::u8;
    std::size_t volume_bytes = 0; ///< on the host
    std::size_t device_bytes = 0; ///< the most at a time, on one device
    double probe_seconds = 0;

    /// Sums over the stages.
    StageEstimate total() const;
};

/// Makes or reads the volume in memory, renders a few passes of views of the scene, takes a few training steps, measures one picture, and
/// estimates from these what an experiment from nothing takes. Writes nothing. Throws Error.
ExperimentEstimate estimate_experiment(const ExperimentSettings& settings, const std::string& folder, std::vector<Device> devices,
                                       const ExperimentControl& control);

} // namespace clvr
