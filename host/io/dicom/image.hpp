// The header of a DICOM image, without the places of its frames.
#pragma once
#include "host/io/dicom/frame.hpp"

namespace clvr {

/// Nothing when the file holds no image. `file` stays where it is: its elements are still needed. Throws as frames_of does.
std::optional<DicomImage> image_of(const DicomFile& file, const std::string& path);

} // namespace clvr
