// How to read a volume file: what the user says about it.
#pragma once
#include "host/volume/vec.hpp"

#include <optional>
#include <string>

namespace clvr {

/// How to read a file that holds several volumes, or that does not say everything itself.
struct VolumeReadOptions {
    int frame = 0;                  ///< which time of a series
    std::optional<int> channel;     ///< which channel of a file with several; absent: the first, and the reader says so
    std::string array;              ///< VTK: the data array of this name; empty: the file's active or only one
    std::string series;             ///< DICOM SeriesInstanceUID; empty: the series with the most slices that make a volume
    bool allow_gaps = false;        ///< accept a DICOM series with missing slices
    bool recursive = false;         ///< search folders inside the folder too
    std::optional<Int3> dims;       ///< RAW
    std::string type;               ///< RAW: uint8, int8, uint16, int16, float32, float64, uint32, int32
    std::optional<Double3> spacing; ///< [mm]; where the file gives none (RAW, TIFF, PNG, NumPy, HDF5)
    std::string endian;             ///< RAW: little (default) or big
};

} // namespace clvr
