// One slice of a DICOM file. Volumes are made of these, whether a file holds one frame, many frames, or a mosaic.
#pragma once
#include "host/io/dicom/file.hpp"
#include "host/io/volume/samples.hpp"
#include "host/volume/vec.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// How the pixels of a picture are stored.
struct DicomPixels {
    int columns = 0, rows = 0, bits_allocated = 16, bits_stored = 16, high_bit = 15;
    bool is_signed = false, is_float = false, inverse = false; ///< inverse: MONOCHROME1
    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    std::size_t sample_bytes() const { return static_cast<std::size_t>(bits_allocated) / 8; }
    std::size_t bytes() const { return count() * sample_bytes(); }
    SampleType type() const;
};

/// Stored values that are no measurement, both ends included.
struct DicomPadding {
    double low, high;
};

/// Stored value -> physical value: values[stored - first], held constant outside.
struct DicomLut {
    double first = 0;
    int bits = 16; ///< of an entry
    std::vector<std::uint16_t> values;
};

/// What the header of one file says of all its frames.
struct DicomImage {
    std::string path, series, description, instance_uid, modality, image_type;
    double instance = 0, acquisition = 0; ///< InstanceNumber, TemporalPositionIdentifier or AcquisitionNumber
    DicomFile file;
    std::size_t frames = 1;
    std::vector<std::size_t> first_fragment; ///< of each frame, and one for the end; of encapsulated pixels
    DicomPixels pixels;                      ///< of one frame of the file
    std::optional<DicomPadding> padding;
    std::optional<DicomLut> lut;
    std::vector<std::string> notes, decisions; ///< for Voxels, where a frame of it becomes a slice
};

/// Where a slice lies. Patient coordinates are LPS [mm], as clvr's world.
struct DicomPlace {
    Double3 position{0, 0, 0};             ///< centre of the first voxel
    Double3 row{1, 0, 0}, column{0, 1, 0}; ///< unit directions along a row (i) and along a column (j)
    double spacing_i = 1, spacing_j = 1;   ///< between columns, between rows [mm]
    double thickness = 0;                  ///< [mm], for a series of one slice; 0: not known, NaN: not readable
    Double3 rounding{0, 0, 0};             ///< the last decimal of each coordinate in the text [mm]; 0: not rounded
};

/// A slice.
struct DicomFrame {
    std::shared_ptr<const DicomImage> image;
    std::size_t number = 0;              ///< frame of the file
    int first_column = 0, first_row = 0; ///< of the part of the picture that is the slice (mosaics)
    int columns = 0, rows = 0;
    double time = 0; ///< orders the frames of a file that lie at one place
    double slope = 1, intercept = 0;
    DicomPlace place;
    std::string stack;                         ///< StackID
    std::map<std::string, std::string> labels; ///< what slices at one place may differ in, and how: {"EchoTime", "4.9"}
    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// The slices of a file by its header; none when it holds no image. Throws Error{input} for an image that is no slice of grey values, and
/// DicomSliceError where a value that decides its place or its voxels is no number.
std::vector<DicomFrame> frames_of(DicomFile&& file, const std::string& path);

} // namespace clvr
