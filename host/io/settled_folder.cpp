#include "host/io/settled_folder.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace clvr {

namespace fs = std::filesystem;

void begin_settled_folder(const std::string& folder, const std::string& name, const std::string& text, const std::string& conflict) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw Error(ErrorKind::input, fmt::format("cannot be made: {}", failed.message()), folder);
    const std::string path = (fs::path(folder) / name).string();
    if (!fs::exists(path)) return write_atomically(path, text);
    if (read_text(path) != text) throw Error(ErrorKind::input, conflict, folder);
}

} // namespace clvr
