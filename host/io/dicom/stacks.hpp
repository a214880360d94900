// Which slices of a series can lie in one volume at all.
#pragma once
#include "host/io/dicom/frame.hpp"

#include <cstddef>
#include <vector>

namespace clvr {

/// Groups of slices of the same size, type, direction and pixel spacing, in order of appearance: indices into `frames`. Localizers stand
/// apart from others; stacks with a StackID each (enhanced DICOM) too, unless they lie at the same places.
std::vector<std::vector<std::size_t>> stacks_of(const std::vector<DicomFrame>& frames);

} // namespace clvr
