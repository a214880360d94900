// Sets of OME-TIFF files that make up one image.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// Whether `files`, all TIFF files of a folder, are one set: the OME-XML of the first names several files, each of `files` among them.
/// Throws Error{input} where it names several but not all of them.
bool is_ome_set(const std::string& folder, const std::vector<std::string>& files);

} // namespace clvr
