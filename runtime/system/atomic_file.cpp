#include "runtime/system/atomic_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/temporary.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

namespace clvr {
namespace fs = std::filesystem;

namespace {

std::string reason() { return std::strerror(errno); }

/// An open file descriptor, closed on destruction.
struct Descriptor {
    int fd;
    explicit Descriptor(int f) : fd(f) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd >= 0) ::close(fd);
    }
};

/// A fresh empty file in a folder. Throws Error{input} naming `wanted_path`.
Temporary temporary_in(const fs::path& folder, const std::string& wanted_path) {
    remove_stale_files(folder.string());
    Temporary made = Temporary::file_in(folder.string());
    if (made.path().empty())
        throw Error(ErrorKind::input, fmt::format("cannot write here: {}; choose a folder that exists and is writable", reason()),
                    wanted_path);
    return made;
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

void synchronise(const std::string& path, int flags) {
    const Descriptor file(::open(path.c_str(), flags | O_CLOEXEC));
    // EINVAL, EROFS, ENOTSUP: this kind of file has nothing to synchronise.
    if (file.fd < 0 || (::fsync(file.fd) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP))
        throw Error(ErrorKind::input, "cannot be brought to disk: " + reason(), path);
}

} // namespace

fs::path final_place(const fs::path& path) {
    constexpr int most_links = 40; // as many as the system follows
    fs::path place = path;
    std::error_code failed;
    for (int k = 0; k < most_links && fs::is_symlink(fs::symlink_status(place, failed)); ++k) {
        const fs::path target = fs::read_symlink(place, failed);
        if (failed) break;
        place = target.is_absolute() ? target : place.parent_path() / target;
    }
    return place;
}

void check_writable(const std::string& path) {
    if (path.empty()) throw Error(ErrorKind::input, "an output file needs a name");
    std::error_code failed;
    const fs::path place = final_place(path);
    const fs::file_status found = fs::status(place, failed);
    if (fs::is_directory(found)) throw Error(ErrorKind::input, "is a folder; expected the name of a file", path);
    if (fs::exists(found) && !fs::is_regular_file(found))
        throw Error(ErrorKind::input, "is not a regular file, so it cannot be replaced; choose another name", path);
    if (fs::exists(found) && ::access(place.c_str(), W_OK) != 0)
        throw Error(ErrorKind::input, "exists and must not be overwritten: " + reason(), path);
    const fs::path folder = folder_of(place);
    if (!fs::is_directory(fs::status(folder, failed)))
        throw Error(ErrorKind::input, fmt::format("there is no folder '{}'; make it first", folder.string()), path);
    if (const auto longest = ::pathconf(folder.c_str(), _PC_NAME_MAX);
        longest > 0 && place.filename().string().size() > static_cast<std::size_t>(longest))
        throw Error(ErrorKind::input, fmt::format("the file name is longer than the {} bytes that the folder allows", longest), path);
    temporary_in(folder, path);
}

void write_atomically(const std::string& path, const std::function<void(const std::string& temporary_path)>& write) {
    check_writable(path);
    const fs::path place = final_place(path);
    Temporary temporary = temporary_in(folder_of(place), path);
    write(temporary.path());
    synchronise(temporary.path(), O_RDONLY);
    if (std::rename(temporary.path().c_str(), place.c_str()) != 0) throw Error(ErrorKind::input, "cannot be replaced: " + reason(), path);
    temporary.give_up();
    synchronise(folder_of(place).string(), O_RDONLY | O_DIRECTORY);
}

void write_atomically(const std::string& path, const void* bytes, std::size_t size) {
    write_atomically(path, [&](const std::string& temporary_path) {
        const Descriptor file(::open(temporary_path.c_str(), O_WRONLY | O_CLOEXEC));
        const char* next = static_cast<const char*>(bytes);
        std::size_t left = size;
        while (file.fd >= 0 && left > 0) {
            const ssize_t written = ::write(file.fd, next, left);
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) break;
            next += written;
            left -= static_cast<std::size_t>(written);
        }
        if (file.fd < 0 || left > 0)
            throw Error(ErrorKind::input,
                        fmt::format("cannot be written, {} of {} bytes are missing: {}; is the disk full?", left, size, reason()), path);
    });
}

void check_readable(const std::string& path) {
    std::error_code ignored; // whatever fails here fails again, with its reason, on opening
    if (fs::is_directory(path, ignored)) throw Error(ErrorKind::input, "is a folder; expected a file", path);
    if (!std::ifstream(path, std::ios::binary)) throw Error(ErrorKind::input, "cannot be opened: " + reason(), path);
}

std::string read_text(const std::string& path, std::size_t limit_bytes) {
    check_readable(path);
    std::ifstream in(path, std::ios::binary);
    std::string text;
    std::array<char, 1 << 16> block;
    while (in.read(block.data(), block.size()), in.gcount() > 0) {
        if (text.size() + static_cast<std::size_t>(in.gcount()) > limit_bytes)
            throw Error(ErrorKind::input, fmt::format("is larger than {} bytes, which is more than a file of this kind holds", limit_bytes),
                        path);
        text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad()) throw Error(ErrorKind::input, "cannot be read: " + reason(), path);
    return text;
}

} // namespace clvr
