#include "tools/bench/view_client.hpp"
#include "runtime/error.hpp"
#include "tools/bench/statistics.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <optional>

namespace clvr::bench {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

constexpr std::size_t header_bytes = 32;
constexpr auto patience = std::chrono::seconds(60); // the first picture of a large volume waits for programs to be built

template <class T>
T little_endian(const std::string& bytes, std::size_t at) {
    T value = 0;
    for (std::size_t k = sizeof(T); k-- > 0;) value = static_cast<T>(value << 8 | static_cast<unsigned char>(bytes[at + k]));
    return value;
}

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorKind::internal, what, "the view's socket"); }

} // namespace

class ViewClient::Socket {
public:
    explicit Socket(int port) {
        try {
            const asio::ip::tcp::endpoint to(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
            stream_.next_layer().connect(to);
            stream_.next_layer().set_option(asio::ip::tcp::no_delay(true));
            const std::string host = fmt::format("127.0.0.1:{}", port);
            stream_.set_option(beast::websocket::stream_base::decorator(
                [host](beast::websocket::request_type& r) { r.set(beast::http::field::origin, "http://" + host); }));
            stream_.handshake(host, "/socket");
        } catch (const boost::system::system_error& error) {
            fail(error.what());
        }
    }
    void say(const nlohmann::json& message) {
        beast::error_code error;
        stream_.text(true);
        stream_.write(asio::buffer(message.dump()), error);
        if (error) fail(error.message());
    }
    /// The next message, and whether it is binary.
    std::pair<std::string, bool> next() {
        beast::flat_buffer buffer;
        std::optional<beast::error_code> done;
        stream_.async_read(buffer, [&](beast::error_code error, std::size_t) { done = error; });
        io_.restart();
        io_.run_for(patience);
        if (!done) { // the buffer is left only once the read has ended
            stream_.next_layer().close();
            io_.run();
            fail("nothing came for a minute");
        }
        if (*done) fail(done->message());
        return {beast::buffers_to_string(buffer.data()), stream_.got_binary()};
    }

private:
    asio::io_context io_{1};
    beast::websocket::stream<asio::ip::tcp::socket> stream_{io_};
};

ViewClient::ViewClient(int port, const std::string& token) : socket_(std::make_unique<Socket>(port)) {
    socket_->say({{"type", "hello"}, {"token", token}, {"role", "control"}});
    const auto hello = nlohmann::json::parse(socket_->next().first);
    if (hello.value("role", "") != "control") fail("control was not given");
    generation_ = hello.at("generation");
}

ViewClient::~ViewClient() = default;

std::uint64_t ViewClient::send_scene(const std::string& scene) {
    socket_->say({{"type", "scene"}, {"generation", ++generation_}, {"scene", nlohmann::json::parse(scene)}});
    return generation_;
}

ViewPicture ViewClient::next_picture() {
    for (;;) {
        const auto [bytes, binary] = socket_->next();
        if (!binary) {
            const auto message = nlohmann::json::parse(bytes);
            const std::string type = message.at("type");
            if (type == "refused" || type == "bye") fail(message.value("message", type));
            continue;
        }
        if (bytes.size() < header_bytes) fail("a picture without its header came");
        ViewPicture p;
        p.at = steady_seconds();
        p.number = little_endian<std::uint32_t>(bytes, 4), p.generation = little_endian<std::uint64_t>(bytes, 8);
        p.samples = static_cast<int>(little_endian<std::uint32_t>(bytes, 16));
        p.width = little_endian<std::uint16_t>(bytes, 20), p.full_width = little_endian<std::uint16_t>(bytes, 24);
        p.divider = static_cast<unsigned char>(bytes[28]), p.phase = static_cast<unsigned char>(bytes[30]);
        p.bytes = bytes.size();
        socket_->say({{"type", "ack"}, {"number", p.number}});
        return p;
    }
}

} // namespace clvr::bench
