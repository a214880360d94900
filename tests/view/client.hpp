// A page's side of HTTP and WebSocket, by plain sockets: it can also say what no browser would.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace clvr::test {

/// A connection.
class Connection {
public:
    explicit Connection(int port) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        open(AF_INET, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    }
    explicit Connection(const std::string& path) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        open(AF_UNIX, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    }
    ~Connection() { close(); }
    Connection(Connection&& other) noexcept : fd_(std::exchange(other.fd_, -1)), read_(std::move(other.read_)) {}
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool connected() const { return fd_ >= 0; }
    int descriptor() const { return fd_; }
    void close() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }
    void send(const std::string& bytes) const {
        for (std::size_t sent = 0; sent < bytes.size();) {
            const ssize_t n = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (n <= 0) return;
            sent += static_cast<std::size_t>(n);
        }
    }
    /// So many bytes; fewer where the other side closes, or says nothing for so long.
    std::string take(std::size_t count, int milliseconds = 5000) {
        while (read_.size() < count && more(milliseconds)) {
        }
        const std::string taken = read_.substr(0, count);
        read_.erase(0, count);
        return taken;
    }
    /// Up to the mark and with it; everything where there is none.
    std::string take_until(const std::string& mark, int milliseconds = 5000) {
        while (read_.find(mark) == std::string::npos && more(milliseconds)) {
        }
        return take(std::min(read_.find(mark), read_.size()) + mark.size(), 0);
    }
    /// Whether the other side closes within that time; what it says until then is lost.
    bool closes(int milliseconds = 5000) {
        while (more(milliseconds)) read_.clear();
        return ended_;
    }

private:
    int fd_ = -1;
    bool ended_ = false;
    std::string read_;

    void open(int family, const sockaddr* address, socklen_t size) {
        fd_ = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (::connect(fd_, address, size) != 0) close();
    }
    bool more(int milliseconds) {
        pollfd wanted{fd_, POLLIN, 0};
        if (poll(&wanted, 1, milliseconds) <= 0) return false;
        char block[1 << 16];
        const ssize_t n = recv(fd_, block, sizeof block, 0);
        if (n <= 0) return ended_ = true, false;
        read_.append(block, static_cast<std::size_t>(n));
        return true;
    }
};

struct Reply {
    int status = 0; ///< 0: none came
    std::map<std::string, std::string> headers;
    std::string body;
};

inline Reply reply_of(Connection& connection) {
    Reply reply;
    const std::string head = connection.take_until("\r\n\r\n");
    if (head.compare(0, 9, "HTTP/1.1 ") != 0) return reply;
    reply.status = std::stoi(head.substr(9));
    for (std::size_t at = head.find("\r\n") + 2; at < head.size() && head[at] != '\r'; at = head.find("\r\n", at) + 2) {
        const std::size_t colon = head.find(": ", at);
        reply.headers[head.substr(at, colon - at)] = head.substr(colon + 2, head.find("\r\n", at) - colon - 2);
    }
    if (reply.headers.count("Content-Length")) reply.body = connection.take(std::stoul(reply.headers["Content-Length"]));
    return reply;
}

/// `more`: further header lines, each with its end.
inline std::string request_text(const std::string& method, const std::string& target, const std::string& more = {},
                                const std::string& host = "localhost:1") {
    return method + " " + target + " HTTP/1.1\r\n" + (host.empty() ? "" : "Host: " + host + "\r\n") + more + "\r\n";
}
template <class Address>
Reply request(const Address& address, const std::string& text) {
    Connection connection(address);
    connection.send(text);
    return reply_of(connection);
}

/// A WebSocket.
class Page {
public:
    struct Message {
        int code = -1; ///< 1: text, 2: binary, 8: close, 9: ping; -1: none came, or the connection ended
        std::string bytes;
        nlohmann::json json() const { return nlohmann::json::parse(bytes, nullptr, false); }
    };

    template <class Address>
    explicit Page(const Address& address, const std::string& more = "Origin: http://localhost:1\r\n") : connection_(address) {
        connection_.send(request_text("GET", "/socket",
                                      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                                      "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n" +
                                          more));
        status_ = reply_of(connection_).status;
    }
    Page(Page&&) noexcept = default;

    int status() const { return status_; } ///< 101 where it is open
    Connection& connection() { return connection_; }
    void close() { connection_.close(); }

    void say(const std::string& text) { frame(0x81, text); }
    void say(const nlohmann::json& message) { say(message.dump()); }
    /// Any first byte (0x80 | code), masked.
    void frame(int first, const std::string& bytes) {
        std::string all(1, static_cast<char>(first));
        if (bytes.size() < 126) {
            all += static_cast<char>(0x80 | bytes.size());
        } else {
            const int length_bytes = bytes.size() < 65536 ? 2 : 8;
            all += static_cast<char>(0x80 | (length_bytes == 2 ? 126 : 127));
            for (int i = length_bytes - 1; i >= 0; --i) all += static_cast<char>(bytes.size() >> 8 * i & 0xff);
        }
        connection_.send(all + std::string(4, '\0') + bytes); // a mask of zeros
    }

    /// The next message; pings are answered, unless `answers` is false.
    Message next(int milliseconds = 5000, bool answers = true) {
        for (;;) {
            const std::string head = connection_.take(2, milliseconds);
            if (head.size() < 2) return {};
            std::size_t size = head[1] & 0x7f;
            const std::size_t length_bytes = size == 126 ? 2 : size == 127 ? 8 : 0;
            if (length_bytes > 0) size = 0;
            for (const char c : connection_.take(length_bytes)) size = size << 8 | static_cast<unsigned char>(c);
            Message message{head[0] & 0x0f, connection_.take(size)};
            if (message.code != 9 || !answers) return message;
            frame(0x8a, message.bytes);
        }
    }
    /// The next text of that type; others before it are passed over, pictures acknowledged.
    nlohmann::json next_of(const std::string& type, int milliseconds = 5000) {
        for (;;) {
            const Message message = next(milliseconds);
            if (message.code == 2) acknowledge(message);
            if (message.code == 1 && message.json().value("type", "") == type) return message.json();
            if (message.code == 8 || message.code < 0) {
                ADD_FAILURE() << "no " << type << ", but " << (message.code == 8 ? "closed: " + reason(message) : "nothing");
                return {};
            }
        }
    }
    void acknowledge(const Message& picture) {
        std::uint32_t number = 0;
        picture.bytes.copy(reinterpret_cast<char*>(&number), 4, 4);
        say(nlohmann::json{{"type", "ack"}, {"number", number}});
    }
    /// Why the server closed it; passes over everything before, and answers it.
    std::string close_reason(int milliseconds = 5000) {
        for (;;) {
            const Message message = next(milliseconds);
            if (message.code == 8) frame(0x88, message.bytes);
            if (message.code == 8) return reason(message);
            if (message.code < 0) return "no close";
        }
    }

private:
    Connection connection_;
    int status_ = 0;

    static std::string reason(const Message& close) {
        if (close.bytes.size() < 2) return "";
        const int code = static_cast<unsigned char>(close.bytes[0]) << 8 | static_cast<unsigned char>(close.bytes[1]);
        return std::to_string(code) + " " + close.bytes.substr(2);
    }
};

} // namespace clvr::test
