#include "host/view/socket_file.hpp"
#include "runtime/error.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace clvr::view {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& what) { throw Error(ErrorKind::usage, what, "--socket " + path); }

void prepare_folder(const std::string& path) {
    const fs::path folder = fs::absolute(path).parent_path();
    if (mkdir(folder.c_str(), 0700) == 0) return;
    struct stat found {};
    if (errno != EEXIST || stat(folder.c_str(), &found) != 0)
        refuse(path, fmt::format("its folder cannot be made: {}", std::strerror(errno)));
    if (!S_ISDIR(found.st_mode)) refuse(path, "its folder is none");
    if (found.st_uid != geteuid() || (found.st_mode & 0077) != 0)
        refuse(path, fmt::format("other users get into the folder {}; name one that is not there yet, or chmod 700 it", folder.string()));
}

bool somebody_listens(const sockaddr_un& address) {
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const bool connected = fd >= 0 && connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    if (fd >= 0) close(fd);
    return connected;
}

} // namespace

SocketFile::SocketFile(const std::string& path) : path_(path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path)
        refuse(path, fmt::format("is longer than the {} bytes that a socket's path may have", sizeof address.sun_path - 1));
    std::memcpy(address.sun_path, path.data(), path.size());
    prepare_folder(path);
    struct stat found {};
    if (lstat(path.c_str(), &found) != 0) return;
    if (!S_ISSOCK(found.st_mode)) refuse(path, "is there already, and is no socket");
    if (somebody_listens(address)) refuse(path, "is in use; name another");
    unlink(path.c_str());
}

SocketFile::~SocketFile() {
    if (made_) unlink(path_.c_str());
}

void SocketFile::made() {
    made_ = true;
    chmod(path_.c_str(), 0600);
}

} // namespace clvr::view
