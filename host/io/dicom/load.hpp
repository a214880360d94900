// The voxels of a DICOM volume: stored pixels, their scale, their padding.
#pragma once
#include "host/io/dicom/arrange.hpp"
#include "host/volume/voxels.hpp"

namespace clvr {

/// Sets everything of `v` but its source, format and modality, from the arranged slices. Throws Error{input}.
void load_slices(const std::vector<DicomFrame>& frames, const Arrangement& a, Voxels& v, const std::string& path);

} // namespace clvr
