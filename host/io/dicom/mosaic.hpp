// Siemens mosaics: the slices of a volume as tiles of one picture.
#pragma once
#include "host/io/dicom/frame.hpp"

namespace clvr {

/// What a Siemens header says of its picture.
struct DicomMosaic {
    int images = 0;                ///< how many tiles hold a slice; 0: not said
    std::optional<Double3> normal; ///< from slice to slice, not yet checked
};
/// Nothing where the picture is no mosaic.
std::optional<DicomMosaic> mosaic_of(const DicomElements& data, const DicomImage& image);
/// The slices of the picture `whole`, which is placed as if the mosaic were one slice; the slices are `step` apart [mm]. Throws
/// Error{input} where the file does not say enough.
std::vector<DicomFrame> mosaic_slices(const DicomMosaic& mosaic, const DicomFrame& whole, std::optional<double> step);

} // namespace clvr
