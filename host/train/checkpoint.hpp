// The state of a training on disk.
#pragma once
#include "host/train/trainer.hpp"

#include <string>
#include <vector>

namespace clvr {

struct Checkpoint {
    std::string configuration; ///< JSON of all that decides the training; a resumed one must have the same
    OptimizerState state;
    Model best;
    double best_validation = 0;
    std::vector<EpochRecord> records; ///< of the epochs that are done
    double loss_sum = 0;              ///< of the steps of the unfinished one
};

/// Atomically, as safetensors: the present model's tensors, the moments, the best model, the rest as metadata.
void write_checkpoint(const Checkpoint& checkpoint, const Model& shape, const std::string& path);
/// Throws Error{input} when the file is damaged or of another configuration than the given one.
Checkpoint read_checkpoint(const std::string& path, const std::string& configuration);

} // namespace clvr
