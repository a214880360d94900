#include "host/io/file_roles.hpp"
#include "host/io/volume/dataset_path.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <optional>
#include <sys/stat.h>
#include <tuple>
#include <unistd.h>

namespace clvr {
namespace fs = std::filesystem;

namespace {

/// Device and inode. For a file that does not exist yet: those of its folder, and its name.
using Identity = std::tuple<dev_t, ino_t, std::string>;

std::optional<Identity> identity_of(const struct stat& s) {
    if (!S_ISREG(s.st_mode)) return std::nullopt;
    return Identity{s.st_dev, s.st_ino, ""};
}

/// Nothing for what exists and is no regular file.
std::optional<Identity> identity_of(const std::string& path) {
    struct stat s {};
    if (::stat(path.c_str(), &s) == 0) return identity_of(s);
    const fs::path place = final_place(path);
    const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
    if (::stat(folder.c_str(), &s) == 0) return Identity{s.st_dev, s.st_ino, place.filename().string()};
    std::error_code failed;
    return Identity{0, 0, fs::absolute(place, failed).lexically_normal().string()};
}

/// `said` is what the user or a file called it: the path of the file, or FILE:/path/of/dataset.
struct Named {
    std::string file, said, name;
    std::string text() const { return name.empty() ? said : fmt::format("{} ({})", said, name); }
};

struct Roles {
    std::mutex mutex;
    std::map<Identity, Named> read, written;
};

Roles& roles() {
    static Roles all;
    return all;
}

/// What `among` knows of the file. A file that was removed or replaced since it was named is forgotten: its inode may be another file's
/// now.
const Named* find(std::map<Identity, Named>& among, const Identity& file) {
    const auto found = among.find(file);
    if (found == among.end()) return nullptr;
    if (identity_of(found->second.file) == file) return &found->second;
    among.erase(found);
    return nullptr;
}

[[noreturn]] void refuse(const Named& output, const std::string& is) {
    throw Error(ErrorKind::usage, fmt::format("{} is {}, which must not be overwritten; choose another name", output.said, is),
                output.name);
}

/// Whether standard output or standard error goes to the file.
bool is_printed_to(const Identity& file) {
    for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) {
        struct stat s {};
        if (::fstat(fd, &s) == 0 && identity_of(s) == file) return true;
    }
    return false;
}

} // namespace

void will_read(const std::string& path, const std::string& name) {
    const Named input{split_dataset_path(path).file, path, name};
    const auto file = identity_of(input.file);
    if (!file) return;
    Roles& all = roles();
    const std::lock_guard lock(all.mutex);
    if (const Named* output = find(all.written, *file)) refuse(*output, "the input " + input.text());
    if (!name.empty() && is_printed_to(*file)) refuse({"", "standard output", "clvr"}, "the input " + input.text());
    all.read.emplace(*file, input);
}

void will_write(const std::string& path, const std::string& name) {
    const auto file = identity_of(path);
    if (!file) return;
    const Named output{path, path, name};
    Roles& all = roles();
    const std::lock_guard lock(all.mutex);
    if (const Named* input = find(all.read, *file)) refuse(output, "the input " + input->text());
    if (is_printed_to(*file)) refuse(output, "the file that standard output goes to");
    if (const Named* other = find(all.written, *file)) refuse(output, "the output " + other->text() + ", too");
    all.written.emplace(*file, output);
}

void forget_file_roles() {
    Roles& all = roles();
    const std::lock_guard lock(all.mutex);
    all.read.clear();
    all.written.clear();
}

} // namespace clvr
