// A connection before it is a WebSocket: the page's files, downloads, uploads.
#pragma once
#include "host/view/beast/request.hpp"
#include "host/view/beast/web_socket.hpp"
#include "host/view/page_file.hpp"

#include <limits>

namespace clvr::view {

template <class Stream>
class HttpConnection : public std::enable_shared_from_this<HttpConnection<Stream>> {
public:
    HttpConnection(Stream&& stream, Shared& shared) : stream_(std::move(stream)), shared_(shared) { ++shared_.connections; }
    ~HttpConnection() { --shared_.connections; }

    void begin() {
        if constexpr (is_secure<Stream>) {
            allow(shared_.settings.header_s);
            stream_.async_handshake(asio::ssl::stream_base::server, [self = this->shared_from_this()](ErrorCode failed) {
                if (!failed) self->read();
            });
        } else {
            read();
        }
    }

private:
    static constexpr const char* plain_text = "text/plain; charset=utf-8";
    static constexpr double stall_s = 30;                   // without any byte sent or received
    static constexpr std::uint32_t header_bytes = 32 << 10; // proxies add cookies
    Stream stream_;
    Shared& shared_;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::empty_body>> header_;

    void allow(double seconds) { beast::get_lowest_layer(stream_).expires_after(duration(seconds)); }

    void read() {
        header_.emplace();
        header_->header_limit(header_bytes);
        header_->body_limit(std::numeric_limits<std::uint64_t>::max()); // upload() has its own (with none, Beast 1.74 refuses every body)
        allow(shared_.settings.header_s);
        http::async_read_header(stream_, buffer_, *header_, [self = this->shared_from_this()](ErrorCode failed, std::size_t) {
            if (!failed) return self->answer();
            if (is_malformed(failed)) self->say(http::status::bad_request);
        });
    }

    void answer() {
        const Header& request = header_->get();
        const Target target(request, shared_.base_path);
        if (!host_allowed(request, shared_) || !origin_allowed(request, shared_)) return say(http::status::forbidden);
        if (target.path == "socket") return upgrade();
        if (target.path == "environment") return upload(target.value("name"));
        const PageFile file = page_file(target.path);
        const bool download = target.path.compare(0, 6, "saved/") == 0;
        if (!file.text && !download) return say(http::status::not_found);
        if (request.method() != http::verb::get) return say(http::status::method_not_allowed);
        if (has_body(*header_)) return say(http::status::payload_too_large);
        if (download) return send_saved(target.path.substr(6));
        say(http::status::ok, *file.text, file.type);
    }

    void upgrade() {
        const Header& request = header_->get();
        if (request.method() != http::verb::get) return say(http::status::method_not_allowed);
        if (!websocket::is_upgrade(request)) return say(http::status::upgrade_required);
        if (request[http::field::origin].empty()) return say(http::status::forbidden);
        if (shared_.clients.size() >= most_clients) return say(http::status::service_unavailable);
        std::make_shared<WebSocket<Stream>>(std::move(stream_), shared_)->begin(request);
    }

    // --- downloads

    void send_saved(const std::string& address) {
        if (!authorized(header_->get(), shared_)) return say(http::status::unauthorized);
        const std::size_t slash = address.find('/');
        const std::optional<SavedFile> saved =
            slash == address.npos ? std::nullopt : shared_.handler->saved(address.substr(0, slash), decoded(address.substr(slash + 1)));
        if (!saved) return say(http::status::not_found);
        auto response = head<http::file_body>(http::status::ok);
        ErrorCode failed;
        response.body().open(saved->path.c_str(), beast::file_mode::read, failed);
        if (failed) return say(http::status::not_found);
        response.set(http::field::content_type, "application/octet-stream");
        response.set(http::field::content_disposition, "attachment; filename*=UTF-8''" + encoded(saved->name));
        send(std::move(response));
    }

    // --- uploads

    void upload(const std::string& name) {
        if (header_->get().method() != http::verb::post) return say(http::status::method_not_allowed);
        if (!authorized(header_->get(), shared_)) return say(http::status::unauthorized);
        if (!header_->content_length()) return say(http::status::length_required);
        if (*header_->content_length() > shared_.settings.upload_bytes) return say(http::status::payload_too_large);
        const std::string place = shared_.handler->place_for_upload();
        if (place.empty()) return say(http::status::conflict);
        auto parser = std::make_shared<http::request_parser<http::file_body>>(std::move(*header_));
        parser->body_limit(shared_.settings.upload_bytes);
        ErrorCode failed;
        parser->get().body().open(place.c_str(), beast::file_mode::write, failed);
        if (failed) {
            shared_.handler->upload_failed(place);
            return say(http::status::insufficient_storage);
        }
        receive(std::move(parser), place, name);
    }

    using Upload = std::shared_ptr<http::request_parser<http::file_body>>;

    void receive(Upload parser, const std::string& place, const std::string& name) {
        allow(stall_s);
        auto& p = *parser;
        http::async_read_some(stream_, buffer_, p, [=, self = this->shared_from_this()](ErrorCode failed, std::size_t) {
            if (failed) {
                parser->get().body().close();
                return self->shared_.handler->upload_failed(place);
            }
            parser->is_done() ? self->received(parser, place, name) : self->receive(parser, place, name);
        });
    }

    void received(const Upload& parser, const std::string& place, const std::string& name) {
        parser->get().body().close();
        beast::get_lowest_layer(stream_).expires_never(); // while it is looked at
        shared_.handler->uploaded(place, name, [self = this->shared_from_this()](const Answer& answer) {
            asio::post(self->shared_.io, [self, answer] {
                self->say(static_cast<http::status>(answer.status), answer.text, answer.status == 200 ? "application/json" : plain_text);
            });
        });
    }

    // --- answers

    template <class Body>
    http::response<Body> head(http::status status) {
        http::response<Body> response(status, 11);
        response.set(http::field::cache_control, "no-store");
        response.set("Content-Security-Policy", content_policy);
        response.set("X-Content-Type-Options", "nosniff");
        response.set("Referrer-Policy", "no-referrer");
        return response;
    }

    void say(http::status status, const std::string& body, const char* type) {
        auto response = head<http::string_body>(status);
        response.set(http::field::content_type, type);
        response.body() = body;
        send(std::move(response));
    }

    void say(http::status status) { say(status, words_of(status), plain_text); }

    template <class Body>
    struct Sent {
        http::response<Body> response;
        http::response_serializer<Body> serializer{response};
        bool keep_alive;
        Sent(http::response<Body>&& r, bool keep) : response(std::move(r)), keep_alive(keep) {
            response.keep_alive(keep);
            response.prepare_payload();
        }
    };

    /// Only what was wholly understood leaves the connection open for more.
    template <class Body>
    void send(http::response<Body>&& response) {
        const bool keep = response.result() == http::status::ok && header_ && header_->is_done() && header_->keep_alive();
        send_some(std::make_shared<Sent<Body>>(std::move(response), keep));
    }

    template <class Body>
    void send_some(const std::shared_ptr<Sent<Body>>& sent) {
        allow(stall_s);
        http::async_write_some(stream_, sent->serializer, [self = this->shared_from_this(), sent](ErrorCode failed, std::size_t) {
            if (failed) return;
            if (!sent->serializer.is_done()) return self->send_some(sent);
            sent->keep_alive ? self->read() : self->finish();
        });
    }

    void finish() {
        ErrorCode ignored;
        beast::get_lowest_layer(stream_).socket().shutdown(asio::socket_base::shutdown_send, ignored);
    }
};

} // namespace clvr::view
