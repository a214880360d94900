#include "host/io/volume/dataset_path.hpp"

#include <filesystem>

namespace clvr {

DatasetPath split_dataset_path(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (fs::exists(path, error)) return {path, {}};
    for (auto colon = path.find(':'); colon != std::string::npos; colon = path.find(':', colon + 1))
        if (const std::string file = path.substr(0, colon); fs::is_regular_file(file, error))
            return {file, colon + 1 < path.size() ? path.substr(colon + 1) : "/"};
    return {path, {}};
}

DatasetPath file_within_path(const std::string& path) {
    std::error_code error;
    for (auto slash = path.find('/', 1); slash != std::string::npos; slash = path.find('/', slash + 1))
        if (const std::string file = path.substr(0, slash); std::filesystem::is_regular_file(file, error))
            return {file, path.substr(slash)};
    return {path, {}};
}

std::string join_dataset_path(const DatasetPath& path) { return path.inside.empty() ? path.file : path.file + ":" + path.inside; }

} // namespace clvr
