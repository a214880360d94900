// Volume files of every supported format into Voxels.
#pragma once
#include "host/volume/voxels.hpp"

#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// How to read a file that does not say it all by itself.
struct VolumeReadOptions {
    int frame = 0;                  ///< which frame of a 4-D file
    std::string series;             ///< DICOM SeriesInstanceUID; empty: the series with most voxels
    bool allow_gaps = false;        ///< accept a DICOM series with missing slices
    std::optional<Int3> dims;       ///< RAW
    std::string type;               ///< RAW: uint8, int8, uint16, int16, float32, float64, uint32, int32
    std::optional<Double3> spacing; ///< RAW [mm]
    std::string endian;             ///< RAW: little (default) or big
};

/// Reads `path`: NIfTI, NRRD, MetaImage, a DICOM file or folder, TIFF, VTK image, RAW (name_WxHxD_type.raw, JSON sidecar, or options), .gz
/// where the format has it. Every container is checked (header against byte count, gzip to its end, spacing and direction finite and
/// nonzero) before its decoder runs. Throws Error{input}: one line with the file, what was expected and found, and what to try.
Voxels read_volume(const std::string& path, const VolumeReadOptions& options = {});

/// SHA-256 (hex) of dims, type and decoded voxels.
std::string volume_sha256(const Voxels& v);

/// Writes NIfTI-1, .nii or .nii.gz, with the stored values, their scale and the geometry (float32: as NIfTI keeps it); atomically. Throws
/// Error{input}: another ending, too large, cannot be written.
void write_nifti(const Voxels& voxels, const std::string& path);
/// Throws Error{input} unless write_nifti could write there: called before the work starts.
void check_nifti_path(const std::string& path);

} // namespace clvr
