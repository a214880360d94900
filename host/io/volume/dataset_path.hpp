// FILE:/path/of/dataset, as users name one data set of an HDF5 file.
#pragma once
#include <string>

namespace clvr {

/// A file, and what is named inside it: "/volume/raw", or empty.
struct DatasetPath {
    std::string file, inside;
};

/// Splits at the first ":" that follows the name of an existing file; where there is none, or all of `path` is a file or folder, the whole
/// is the file.
DatasetPath split_dataset_path(const std::string& path);
/// What `path` may mean where a part of it is a file, as in FILE/path/of/dataset; `inside` is empty where no part is.
DatasetPath file_within_path(const std::string& path);
/// "FILE:/path", or the file alone.
std::string join_dataset_path(const DatasetPath& path);

} // namespace clvr
