// A Unix socket's place in the file system.
#pragma once
#include <string>

namespace clvr::view {

/// Only its owner gets to it: its folder has mode 0700, the socket 0600. Removed at the end.
class SocketFile {
public:
    /// Makes the folder where there is none, and removes a socket that nobody listens to. Throws Error{usage}: the folder is open to other
    /// users, the socket is in use, the path is too long or something else.
    explicit SocketFile(const std::string& path);
    ~SocketFile();
    SocketFile(const SocketFile&) = delete;
    SocketFile& operator=(const SocketFile&) = delete;
    /// The socket is there now.
    void made();

private:
    std::string path_;
    bool made_ = false;
};

} // namespace clvr::view
