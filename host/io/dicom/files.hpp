// Which files may belong to a DICOM series.
#pragma once
#include <string>
#include <vector>

namespace clvr {

struct DicomFiles {
    std::vector<std::string> paths; ///< in order of their names
    std::vector<std::string> notes, decisions;
};

/// Those of `paths` that are DICOM by their bytes (by their names where bytes are silent), and those that a DICOMDIR among them names.
/// Throws Error{input}.
DicomFiles dicom_files_among(const std::vector<std::string>& paths);
/// The files that a DICOMDIR names, which lie beside it or below; nothing where the file is no DICOMDIR.
DicomFiles dicom_directory_files(const std::string& path);

} // namespace clvr
