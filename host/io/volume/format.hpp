// Which format a volume file has.
#pragma once
#include "host/volume/volume_read_options.hpp"

#include <string>

namespace clvr {

enum class VolumeFormat { unknown, nifti, nrrd, metaimage, dicom, tiff, png, jpeg, vtk, vti, numpy, mrc, mgh, hdf5, raw };

/// By the first bytes of a file (1024 are enough): `unknown` where they are silent.
VolumeFormat format_of_head(const std::string& head);
/// By the ending of a file's name, upper or lower case; `unknown` where clvr does not know the ending.
VolumeFormat format_of_name(const std::string& name);
/// Of a file: the bytes decide; the name only where they are silent. --dims makes it RAW. Throws Error{input} for what is no volume.
VolumeFormat format_of_file(const std::string& path, const VolumeReadOptions& options);

/// Whether the text ends, or starts, so.
bool ends_with(const std::string& s, const std::string& end);
bool starts_with(const std::string& s, const std::string& start);

} // namespace clvr
