// A client: its messages in, texts and pictures out.
#pragma once
#include "host/view/beast/common.hpp"
#include "host/view/net_text.hpp"
#include "runtime/error.hpp"

#include <spdlog/spdlog.h>

#include <utility>

namespace clvr::view {

template <class Stream>
class WebSocket final : public Client, public std::enable_shared_from_this<WebSocket<Stream>> {
public:
    WebSocket(Stream&& stream, Shared& shared)
        : socket_(std::move(stream)), shared_(shared), id_(++shared.last_client), authentication_(shared.io) {}

    void begin(const Header& request) {
        shared_.clients[id_] = this->shared_from_this();
        beast::get_lowest_layer(socket_).expires_never(); // it has time-outs of its own
        websocket::stream_base::timeout times{};
        times.handshake_timeout = duration(shared_.settings.header_s);
        times.idle_timeout = duration(2 * shared_.settings.ping_s); // a ping goes out after half of it
        times.keep_alive_pings = true;
        socket_.set_option(times);
        socket_.read_message_max(largest_message);
        socket_.auto_fragment(false); // a picture is one frame
        socket_.async_accept(request, [self = this->shared_from_this()](ErrorCode failed) { self->accepted(failed); });
    }

    bool joined() const override { return joined_; }
    void text(std::shared_ptr<const std::string> text, const std::string& key) override {
        queue_.text(std::move(text), key);
        if (queue_.overfull()) return gone();
        write();
    }
    void picture(std::shared_ptr<const EncodedPicture> picture) override {
        queue_.picture(std::move(picture));
        write();
    }
    void leave(const std::string& reason) override { close(websocket::close_code::going_away, reason); }

private:
    websocket::stream<Stream, false> socket_; // pictures are compressed already
    Shared& shared_;
    const ClientId id_;
    asio::steady_timer authentication_;
    beast::flat_buffer read_;
    ClientQueue queue_;
    Outgoing written_;
    websocket::close_reason leaving_; // with a reason once it is
    bool accepted_ = false, joined_ = false, writing_ = false, closing_ = false;

    /// Without further words. Whatever is under way ends with an error.
    void gone() {
        authentication_.cancel();
        beast::get_lowest_layer(socket_).close();
        if (shared_.clients.erase(id_) == 0) return;
        if (std::exchange(joined_, false)) shared_.handler->left(id_);
    }

    void close(websocket::close_code code, const std::string& reason) {
        if (leaving_) return;
        leaving_ = websocket::close_reason(code, cut_utf8(reason, 120)); // a close frame holds 123 bytes
        write();
    }

    void accepted(ErrorCode failed) {
        if (failed) return gone();
        accepted_ = true;
        authentication_.expires_after(duration(shared_.settings.authenticate_s));
        authentication_.async_wait([self = this->shared_from_this()](ErrorCode cancelled) {
            if (!cancelled && !self->joined_) self->close(websocket::close_code::policy_error, "the token was not said in time");
        });
        write();
        read();
    }

    void read() {
        socket_.async_read(read_, [self = this->shared_from_this()](ErrorCode failed, std::size_t) {
            if (failed) return self->gone();
            self->take();
            self->read();
        });
    }

    /// What is wrong with a message ends this client, and nothing else.
    void take() {
        const std::string text = beast::buffers_to_string(read_.data());
        read_.consume(read_.size());
        if (leaving_) return;
        try {
            if (!socket_.got_text()) throw Error(ErrorKind::input, "is not text", "message");
            take(parse_message(text));
        } catch (const Error& e) {
            close(websocket::close_code::policy_error, e.line());
        } catch (const std::exception& e) {
            spdlog::error("a client's message: {}", e.what());
            close(websocket::close_code::internal_error, "the server made a mistake");
        }
    }

    void take(const ClientMessage& message) {
        if (!joined_) return join(message);
        if (std::holds_alternative<Hello>(message)) throw Error(ErrorKind::input, "is a second hello", "message");
        if (const auto* ack = std::get_if<Ack>(&message)) queue_.acknowledge(ack->number);
        if (const auto* pause = std::get_if<Pause>(&message)) queue_.pause(pause->paused);
        shared_.handler->said(id_, message);
        write();
    }

    void join(const ClientMessage& message) {
        const auto* hello = std::get_if<Hello>(&message);
        if (!hello || !same_token(hello->token, shared_.settings.token))
            throw Error(ErrorKind::input, hello ? "the token is another one" : "the first has to be hello", "message");
        authentication_.cancel();
        joined_ = true;
        shared_.handler->joined(id_, hello->role);
    }

    void write() {
        if (!accepted_ || writing_ || closing_) return;
        if (leaving_ && !queue_.texts_wait()) return end();
        std::optional<Outgoing> next = queue_.next();
        if (!next) return;
        written_ = std::move(*next);
        writing_ = true;
        socket_.binary(written_.binary);
        socket_.async_write(asio::buffer(*written_.bytes), [self = this->shared_from_this()](ErrorCode failed, std::size_t) {
            self->writing_ = false;
            self->written_ = {};
            if (failed) return self->gone();
            self->write();
        });
    }

    void end() {
        closing_ = true;
        socket_.async_close(leaving_, [self = this->shared_from_this()](ErrorCode) { self->gone(); });
    }
};

} // namespace clvr::view
