// What the parts of the server share. Boost.Beast is included here, beside and in server.cpp alone: one translation unit.
#pragma once
#include "host/view/server.hpp"
#include "host/view/token.hpp"

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include <chrono>
#include <map>

namespace clvr::view {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using ErrorCode = boost::system::error_code;

using Plain = beast::basic_stream<asio::generic::stream_protocol>; // over TCP or a Unix socket
using Secure = beast::ssl_stream<Plain>;
template <class Stream>
inline constexpr bool is_secure = std::is_same_v<Stream, Secure>;
using Header = http::request<http::empty_body>;

inline std::chrono::milliseconds duration(double seconds) { return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000)); }

/// A client's WebSocket, as the network sees it.
class Client {
public:
    virtual ~Client() = default;
    virtual bool joined() const = 0;
    virtual void text(std::shared_ptr<const std::string> text, const std::string& key) = 0;
    virtual void picture(std::shared_ptr<const EncodedPicture> picture) = 0;
    /// Closes it once the texts that wait are sent.
    virtual void leave(const std::string& reason) = 0;
};

/// What all connections see: of the network thread alone.
struct Shared {
    ServerSettings settings;
    AllowedHosts allowed;
    std::string base_path;
    Handler* handler = nullptr;
    ClientId last_client = 0;
    int connections = 0; // that are no WebSocket
    asio::io_context io{1};
    std::map<ClientId, std::shared_ptr<Client>> clients;

    explicit Shared(const ServerSettings& s)
        : settings(s), allowed(s.host, s.base_url), base_path(s.base_url.empty() ? std::string() : parse_base_url(s.base_url).path) {}
};

inline std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

} // namespace clvr::view
