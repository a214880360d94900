// Models to and from safetensors files (host/README.md, "Model files").
#pragma once
#include "host/denoise/model.hpp"
#include "host/io/model/safetensors.hpp"

#include <string>
#include <vector>

namespace clvr {

/// Reads a model; "default", "color" and so on (embedded_model_names, where there is no such file) are those inside the binary. A file
/// without metadata and with 10 input channels has the reference's channels and no preprocessing. Throws Error{input}: what is wrong with
/// the header, a tensor, a shape or a weight, and what was expected; Error{usage} when the binary has no such model.
Model read_model(const std::string& path);
/// Names of the models inside the binary; the one that reads the most channels comes first.
std::vector<std::string> embedded_model_names();
/// Writes the four tensors in order, the settings and the notes as metadata; atomically.
void write_model(const Model& model, const std::string& path);

/// The settings alone, as the metadata has them: channels, levels, switches.
std::string model_settings_json(const Model& model);

/// The same within a larger file (a checkpoint). `where` names it in errors.
Model model_of(const TensorFile& file, const std::string& where);
TensorFile tensors_of(const Model& model);

} // namespace clvr
