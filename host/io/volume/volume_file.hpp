// Volume files of every supported format into Voxels.
#pragma once
#include "host/volume/volume_read_options.hpp"
#include "host/volume/voxels.hpp"

#include <string>

namespace clvr {

/// Reads `path`: NIfTI, NRRD, MetaImage, a DICOM file or folder, TIFF, VTK image (legacy or XML), RAW (name_WxHxD_type.raw, JSON sidecar,
/// or options), .gz where the format has it. Every container is checked (header against byte count, gzip to its end, spacing and direction
/// finite and nonzero) before its decoder runs. Throws Error{input}: one line with the file, what was expected and found, and what to try.
Voxels read_volume(const std::string& path, const VolumeReadOptions& options = {});

/// SHA-256 (hex) of dims, type and decoded voxels.
std::string volume_sha256(const Voxels& v);

/// Writes NIfTI-1, .nii or .nii.gz, with the stored values, their scale and the geometry (float32: as NIfTI keeps it); atomically. Throws
/// Error{input}: another ending, too large, cannot be written.
void write_nifti(const Voxels& voxels, const std::string& path);
/// Throws Error{input} unless write_nifti could write there: called before the work starts.
void check_nifti_path(const std::string& path);

} // namespace clvr
