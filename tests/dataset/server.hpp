// An HTTP server on this machine that answers as it is told, bytes for bytes: drops connections, lies about lengths.
#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace clvr::testing {

class Server {
public:
    /// `answer` gets the request's text and gives all that is sent before the connection closes.
    explicit Server(std::function<std::string(const std::string&)> answer) : answer_(std::move(answer)) {
        listener_ = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(listener_, 8) != 0 ||
            getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
            throw std::runtime_error("no local server");
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    ~Server() {
        closing_ = true;
        shutdown(listener_, SHUT_RDWR);
        thread_.join();
        close(listener_);
    }
    std::string url(const std::string& path = "/volume.raw") const { return "http://127.0.0.1:" + std::to_string(port_) + path; }
    std::vector<std::string> requests() const {
        const std::lock_guard lock(mutex_);
        return requests_;
    }

private:
    std::function<std::string(const std::string&)> answer_;
    int listener_ = -1, port_ = 0;
    std::atomic<bool> closing_{false};
    mutable std::mutex mutex_;
    std::vector<std::string> requests_;
    std::thread thread_;

    void serve() {
        while (!closing_) {
            const int connection = accept(listener_, nullptr, nullptr);
            if (connection < 0) continue;
            std::string request;
            char piece[4096];
            while (request.find("\r\n\r\n") == request.npos) {
                const ssize_t n = recv(connection, piece, sizeof piece, 0);
                if (n <= 0) break;
                request.append(piece, static_cast<std::size_t>(n));
            }
            {
                const std::lock_guard lock(mutex_);
                requests_.push_back(request);
            }
            const std::string reply = answer_(request);
            for (std::size_t at = 0; at < reply.size();) {
                const ssize_t n = send(connection, reply.data() + at, reply.size() - at, MSG_NOSIGNAL);
                if (n <= 0) break;
                at += static_cast<std::size_t>(n);
            }
            close(connection);
        }
    }
};

} // namespace clvr::testing
