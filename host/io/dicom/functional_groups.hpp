// Enhanced DICOM: each frame's place and scale in functional groups.
#pragma once
#include "host/io/dicom/frame.hpp"

namespace clvr {

/// The frames of a file with SharedFunctionalGroupsSequence and PerFrameFunctionalGroupsSequence in `data`; `common` holds what all share.
/// Throws as frames_of does.
std::vector<DicomFrame> functional_group_frames(const DicomElements& data, const DicomFrame& common);

} // namespace clvr
