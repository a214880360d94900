// Where a slice lies, by the elements that say so.
#pragma once
#include "host/io/dicom/frame.hpp"

namespace clvr {

/// ImagePositionPatient, ImageOrientationPatient, and PixelSpacing with the thickness, each from the elements that hold it. Throws
/// Error{input} for what cannot be placed, DicomSliceError for what is no number.
DicomPlace place_of(const DicomElements& position, const DicomElements& orientation, const DicomElements& measures,
                    const std::string& path);
/// The unit vector across the slice: row x column.
Double3 normal_of(const DicomPlace& place);

} // namespace clvr
