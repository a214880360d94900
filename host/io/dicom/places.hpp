// The slices of a stack by the places where they lie, and one of them for each.
#pragma once
#include "host/io/dicom/frame.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace clvr {

/// Positions this near to one another [mm] are the same place.
constexpr double same_place_mm = 1e-3;

/// The slices at one place along the normal [mm]: indices of frames.
struct SlicesAtPlace {
    double along;
    std::vector<std::size_t> slices;
};

/// In ascending order along `normal`. Copies of files are dropped, which is noted; a copy agrees in all that it says about itself.
std::vector<SlicesAtPlace> places_of(const std::vector<DicomFrame>& frames, std::vector<std::size_t> stack, const Double3& normal,
                                     std::vector<std::string>& notes);
std::size_t slices_in(const std::vector<SlicesAtPlace>& places);

/// One slice for each place.
struct FrameChoice {
    std::vector<std::size_t> slices;
    std::size_t times = 1; ///< how many slices every place has
    std::vector<std::string> notes;
};
/// Frame number `frame` where every place has that many slices, in the order of their times, echoes or numbers; else the first slice of the
/// set that is at every place, or of all. What is left out is noted. Sorts `places`. Throws Error{input} with `where` for a frame that does
/// not exist.
FrameChoice choose_frame(std::vector<SlicesAtPlace>& places, const std::vector<DicomFrame>& frames, int frame, const std::string& where);

} // namespace clvr
