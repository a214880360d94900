// Which DICOM slices make a volume, and where each lies.
#pragma once
#include "host/io/volume/dicom/file.hpp"
#include "host/volume/geometry.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace clvr {

/// How the pixels of a slice are stored.
struct DicomPixels {
    int columns = 0, rows = 0, bits_allocated = 16, bits_stored = 16;
    bool is_signed = false, inverse = false; ///< inverse: MONOCHROME1
    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    std::size_t bytes() const { return count() * static_cast<std::size_t>(bits_allocated) / 8; }
};

/// What the header of one slice says. Patient coordinates are LPS [mm], as clvr's world.
struct DicomSlice {
    std::string path, series, description, instance_uid, modality;
    double instance = 0, acquisition = 0; ///< InstanceNumber, AcquisitionNumber or TemporalPositionIdentifier
    DicomFile file;
    DicomPixels pixels;
    double slope = 1, intercept = 0;
    Double3 position{0, 0, 0};             ///< centre of the first voxel
    Double3 row{1, 0, 0}, column{0, 1, 0}; ///< unit directions along a row (i) and along a column (j)
    double spacing_i = 1, spacing_j = 1;   ///< between columns, between rows [mm]
    double thickness = 0;                  ///< [mm], for a series of one slice; 0: not known
};

/// Slice k of the volume is slice `low`, or lies between two: (1 - share) * low + share * high.
struct SlicePlace {
    std::size_t low, high;
    double share;
};

struct Arrangement {
    Geometry geometry;
    std::vector<SlicePlace> slices;
    std::vector<std::string> notes;
};

/// Sorts slices of one series along their normal; drops copies (reported); picks time `frame` where every place holds several; finds
/// missing slices: refused, or with `allow_gaps` filled by interpolation between the neighbours (reported). Differing sizes or
/// orientations: the largest group is taken (reported). Reversed and mixed order do not matter. Throws Error{input} with `where`.
Arrangement arrange(const std::vector<DicomSlice>& slices, int frame, bool allow_gaps, const std::string& where);

} // namespace clvr
