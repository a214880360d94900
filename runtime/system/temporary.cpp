#include "runtime/system/temporary.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <random>
#include <set>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace clvr {
namespace fs = std::filesystem;
namespace {

struct Registry {
    std::mutex mutex;
    std::set<std::string> paths;
};

Registry& registry() {
    static Registry* const all = new Registry; // never destroyed: the end of the process may come from another thread
    return *all;
}

void remember(const std::string& path) {
    const std::lock_guard lock(registry().mutex);
    registry().paths.insert(path);
}

void forget(const std::string& path) {
    const std::lock_guard lock(registry().mutex);
    registry().paths.erase(path);
}

void remove(const std::string& path) noexcept {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

/// Whether the opened file or folder still has a name: a process that cleans up may have been faster.
bool has_name(int fd) {
    struct stat s {};
    return ::fstat(fd, &s) == 0 && s.st_nlink > 0;
}

/// Removes what has such a name and is no living process's.
template <class Named>
void remove_unlocked(const std::string& folder, Named&& named) {
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
        if (!named(entry->path().filename().string())) continue;
        const int fd = ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (fd < 0) continue;
        struct stat s {};
        if (::fstat(fd, &s) == 0 && s.st_uid == ::geteuid() && ::flock(fd, LOCK_EX | LOCK_NB) == 0) remove(entry->path().string());
        ::close(fd);
    }
}

bool is_first_time(const std::string& folder) {
    static std::mutex mutex;
    static std::set<std::string> seen;
    const std::lock_guard lock(mutex);
    return seen.insert(folder).second;
}

bool starts_with(const std::string& text, const std::string& start) { return text.compare(0, start.size(), start) == 0; }

} // namespace

Temporary Temporary::file_in(const std::string& folder) {
    static std::atomic<unsigned> counter{0};
    static const unsigned process_word = std::random_device{}();
    Temporary made;
    for (int attempt = 0; attempt < 100; ++attempt) {
        const std::string path = (fs::path(folder) / fmt::format(".clvr-{}-{:08x}-{}.tmp", ::getpid(), process_word, counter++)).string();
        remember(path);
        const int fd = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666); // the umask applies
        if (fd >= 0) {
            ::flock(fd, LOCK_EX);
            made.path_ = path, made.lock_ = fd;
            if (has_name(fd)) return made;
            made = Temporary();
            continue;
        }
        const int why = errno;
        forget(path);
        errno = why;
        if (why != EEXIST) break;
    }
    return {};
}

Temporary Temporary::folder_in(const std::string& folder, const std::string& purpose) {
    std::string path = (fs::path(folder) / fmt::format("clvr-{}-XXXXXX", purpose)).string();
    if (!::mkdtemp(path.data())) return {};
    Temporary made;
    made.path_ = path;
    remember(path);
    made.lock_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (made.lock_ >= 0) ::flock(made.lock_, LOCK_EX);
    return made;
}

Temporary::~Temporary() {
    if (!path_.empty()) {
        remove(path_);
        forget(path_);
    }
    if (lock_ >= 0) ::close(lock_);
}

void Temporary::give_up() {
    if (!path_.empty()) forget(path_);
    path_.clear();
}

void Temporary::swap(Temporary& other) noexcept {
    path_.swap(other.path_);
    std::swap(lock_, other.lock_);
}

void remove_temporaries() noexcept {
    registry().mutex.lock(); // for ever
    for (const std::string& path : registry().paths) remove(path);
}

void remove_stale_files(const std::string& folder) {
    if (!is_first_time(folder)) return;
    remove_unlocked(folder, [](const std::string& name) { return starts_with(name, ".clvr-") && fs::path(name).extension() == ".tmp"; });
}

void remove_stale_folders(const std::string& folder, const std::string& purpose) {
    if (!is_first_time(folder)) return;
    remove_unlocked(folder, [&](const std::string& name) { return starts_with(name, "clvr-" + purpose + "-"); });
}

} // namespace clvr
