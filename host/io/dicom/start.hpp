// How a DICOM file begins.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

namespace clvr {

/// Where the first element of a DICOM file stands and how it is written.
struct DicomStart {
    std::size_t offset = 0; ///< of the first element
    bool has_meta = false;  ///< it is of group 2, which names the syntax of the rest
    bool implicit = false;  ///< elements have no type
    bool big_endian = false;
};

/// By a file's first bytes (1024 are enough): with or without preamble, with or without group 2; nothing for another format. Without the
/// mark DICM two elements must follow each other as the standard has them.
std::optional<DicomStart> dicom_start(const std::string& head);
/// How the elements of a data set that begins so are written.
DicomStart dicom_syntax_of(const std::string& head);

} // namespace clvr
