// Which DICOM slices make a volume, and where each lies.
#pragma once
#include "host/io/dicom/frame.hpp"
#include "host/volume/geometry.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace clvr {

/// Slice k of the volume is frame `low`, or lies between two: (1 - share) * low + share * high.
struct SlicePlace {
    std::size_t low, high;
    double share;
};

struct Arrangement {
    Geometry geometry;
    std::vector<SlicePlace> slices;
    std::size_t places = 0; ///< different places of slices
    std::vector<std::string> notes, decisions;
};

/// Sorts the slices of one stack (stacks_of) along their normal; drops copies (reported); picks frame `frame` where every place holds
/// several; finds missing slices: refused, or with `allow_gaps` filled by interpolation between the neighbours (reported). Reversed and
/// mixed order do not matter. Throws Error{input} with `where`.
Arrangement arrange(const std::vector<DicomFrame>& frames, const std::vector<std::size_t>& stack, int frame, bool allow_gaps,
                    const std::string& where);

} // namespace clvr
