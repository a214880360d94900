#include "host/io/volume/folder.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <filesystem>

namespace clvr {

namespace fs = std::filesystem;

bool is_system_file(const std::string& path) {
    const std::string name = lower_case(fs::path(path).filename().string());
    return name.rfind("._", 0) == 0 || name == ".ds_store" || name == "thumbs.db" || name == "desktop.ini";
}

FolderFiles files_in(const std::string& folder, bool recursive) {
    FolderFiles files;
    std::size_t left_out = 0;
    std::string example;
    const auto take = [&](const fs::directory_entry& entry) {
        if (!entry.is_regular_file()) return;
        const std::string path = entry.path().string();
        if (!is_system_file(path)) return files.paths.push_back(path);
        if (left_out++ == 0 || path < example) example = path;
    };
    try {
        if (recursive)
            for (const auto& entry : fs::recursive_directory_iterator(folder)) take(entry);
        else
            for (const auto& entry : fs::directory_iterator(folder)) take(entry);
    } catch (const fs::filesystem_error& e) {
        bad_file(e.path1().empty() ? folder : e.path1().string(), "cannot be read: {}", e.code().message());
    }
    std::sort(files.paths.begin(), files.paths.end());
    if (left_out > 0)
        files.notes.push_back(fmt::format("{} file{} of the operating system {} left out ({})", left_out, left_out == 1 ? "" : "s",
                                          left_out == 1 ? "was" : "were", fs::path(example).filename().string()));
    return files;
}

} // namespace clvr
