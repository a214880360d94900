// The header of a NRRD file (teem.sourceforge.net/nrrd/format.html).
#pragma once
#include "host/volume/geometry.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace clvr {

struct NrrdHeader {
    std::map<std::string, std::string> fields; ///< lower case, without blanks ("datafile", "spacedirections")
    std::vector<std::string> listed;           ///< what stands behind "data file: LIST"
    bool segmentation = false;                 ///< 3D Slicer's mark of a label map
    std::uint64_t bytes = 0;                   ///< up to the empty line and with it

    /// The value of a field; `fallback` where there is none.
    std::string field(const std::string& name, const std::string& fallback = {}) const;
};

/// Throws Error{input}: no end, a line that is none of a header, a field that clvr needs twice. Fields that it does not know pass.
NrrdHeader parse_nrrd_header(const std::string& path);

/// The words of a field; "(a, b, c)" is one, and so is "\"a b\"" (without its quotes).
std::vector<std::string> nrrd_words(const std::string& text);
/// The words of a field with one for each of `axes` axes; empty where the field is not there. Throws Error{input} for another count.
std::vector<std::string> nrrd_words_per_axis(const NrrdHeader& h, const char* field, std::size_t axes, const std::string& path);

} // namespace clvr
