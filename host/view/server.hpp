// HTTP and WebSocket for a viewer's page. No type of the library that it is made with is seen here.
#pragma once
#include "host/view/client_queue.hpp"
#include "host/view/hosts.hpp"
#include "host/view/limits.hpp"
#include "host/view/messages.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace clvr::view {

using ClientId = std::uint64_t;

/// A file that a client may take with it.
struct SavedFile {
    std::string path, name; ///< where it lies, how the browser shall call it
};

/// An answer to a request.
struct Answer {
    int status = 200;
    std::string text; ///< JSON where the status is 200, else words
};

/// The program behind the server. Called from the network thread, and must not block it. What `said` throws closes that client alone.
class Handler {
public:
    virtual ~Handler() = default;
    /// A client that knows the token.
    virtual void joined(ClientId client, Role wanted) = 0;
    virtual void said(ClientId client, const ClientMessage& message) = 0;
    virtual void left(ClientId client) = 0;
    /// The file of a save, by both parts of its address.
    virtual std::optional<SavedFile> saved(const std::string& job, const std::string& name) = 0;
    /// A file to put an upload into; empty: none is taken now.
    virtual std::string place_for_upload() = 0;
    /// The upload is there, or broken off; `answer` may be called later, from any thread.
    virtual void uploaded(const std::string& path, const std::string& name, std::function<void(Answer)> answer) = 0;
    virtual void upload_failed(const std::string& path) = 0;
};

/// The way to the clients. From any thread; returns at once.
class Clients {
public:
    virtual ~Clients() = default;
    /// Keys as in ClientQueue.
    virtual void send(ClientId client, std::string text, const std::string& key = {}) = 0;
    virtual void send_all(std::string text, const std::string& key = {}) = 0;
    virtual void show(ClientId client, std::shared_ptr<const EncodedPicture> picture) = 0;
    virtual void show_all(std::shared_ptr<const EncodedPicture> picture) = 0;
};

struct ServerSettings {
    std::string host = "127.0.0.1";
    int port = 0;            ///< 0: any that is free
    std::string socket;      ///< path of a Unix socket, in place of host and port
    std::string certificate; ///< PEM files, for TLS
    std::string key;
    std::string base_url; ///< under which a proxy shows the page; its path may be there or not in requests
    std::string token;
    double header_s = 10;      ///< for a request's header, and for handshakes
    double authenticate_s = 5; ///< until a client has said the token
    double ping_s = 20;        ///< and twice that until a client counts as lost
    std::size_t upload_bytes = largest_upload;
};

class Server final : public Clients {
public:
    /// Takes the address. Throws Error{usage} where it is in use or cannot be had, Error{input} for files that are no certificate or key.
    explicit Server(const ServerSettings& settings);
    /// Stops.
    ~Server() override;

    int port() const; ///< 0 for a Unix socket
    /// Serves until stop(); the handler outlives that.
    void start(Handler& handler);
    /// Takes leave of the clients with this message, and gives the address back. Waits at most a second for clients that do not answer.
    void stop(const std::string& bye);

    void send(ClientId client, std::string text, const std::string& key = {}) override;
    void send_all(std::string text, const std::string& key = {}) override;
    void show(ClientId client, std::shared_ptr<const EncodedPicture> picture) override;
    void show_all(std::shared_ptr<const EncodedPicture> picture) override;

private:
    class Network;
    std::unique_ptr<Network> network_;
};

} // namespace clvr::view
