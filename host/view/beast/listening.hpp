// The address that a server has: of TCP, or a Unix socket.
#pragma once
#include "host/view/beast/common.hpp"
#include "host/view/socket_file.hpp"
#include "runtime/error.hpp"

#include <fmt/format.h>

namespace clvr::view {

class Listening {
public:
    /// Throws Error{usage}.
    Listening(asio::io_context& io, const ServerSettings& settings) {
        settings.socket.empty() ? listen_tcp(io, settings) : listen_socket(io, settings.socket);
    }

    int port() const { return port_; }
    void close() {
        ErrorCode ignored;
        if (tcp_) tcp_->close(ignored);
        if (local_) local_->close(ignored);
        file_.reset();
    }
    /// Calls f(socket) for the next connection; for none once closed.
    template <class F>
    void accept(F&& f) {
        tcp_ ? accept(*tcp_, std::forward<F>(f)) : accept(*local_, std::forward<F>(f));
    }

private:
    using Tcp = asio::ip::tcp;
    using Local = asio::local::stream_protocol;
    int port_ = 0;
    std::optional<Tcp::acceptor> tcp_;
    std::optional<SocketFile> file_; // of local_
    std::optional<Local::acceptor> local_;

    void listen_tcp(asio::io_context& io, const ServerSettings& settings) {
        ErrorCode failed;
        Tcp::endpoint endpoint;
        const auto found = Tcp::resolver(io).resolve(settings.host, std::to_string(settings.port), Tcp::resolver::passive, failed);
        if (failed || found.empty())
            throw Error(ErrorKind::usage,
                        fmt::format("is \"{}\", which is no address of this machine: {}", settings.host, failed.message()), "--host");
        endpoint = found.begin()->endpoint();
        tcp_.emplace(io);
        const auto check = [&] {
            if (!failed) return;
            const bool taken = failed == asio::error::address_in_use;
            throw Error(ErrorKind::usage,
                        taken ? fmt::format("{} is in use; name another, or leave it out for any that is free", settings.port)
                              : fmt::format("{} of {} cannot be had: {}", settings.port, settings.host, failed.message()),
                        "--port");
        };
        tcp_->open(endpoint.protocol(), failed), check();
        tcp_->set_option(Tcp::acceptor::reuse_address(true), failed), check();
        tcp_->bind(endpoint, failed), check();
        tcp_->listen(asio::socket_base::max_listen_connections, failed), check();
        port_ = tcp_->local_endpoint().port();
    }

    void listen_socket(asio::io_context& io, const std::string& path) {
        file_.emplace(path);
        local_.emplace(io);
        try {
            local_->open();
            local_->bind(Local::endpoint(path));
            file_->made();
            local_->listen();
        } catch (const boost::system::system_error& e) {
            throw Error(ErrorKind::usage, fmt::format("cannot be had: {}", e.code().message()), "--socket " + path);
        }
    }

    template <class Acceptor, class F>
    static void accept(Acceptor& acceptor, F&& f) {
        acceptor.async_accept(
            [&acceptor, f = std::forward<F>(f)](ErrorCode failed, typename Acceptor::protocol_type::socket socket) mutable {
                if (failed == asio::error::operation_aborted || !acceptor.is_open()) return;
                if (failed) return accept_later(acceptor, std::move(f));
                if constexpr (std::is_same_v<Acceptor, Tcp::acceptor>) {
                    ErrorCode ignored;
                    socket.set_option(Tcp::no_delay(true), ignored);
                }
                f(asio::generic::stream_protocol::socket(std::move(socket)));
            });
    }

    /// The process may have no descriptor left: another try in a while.
    template <class Acceptor, class F>
    static void accept_later(Acceptor& acceptor, F&& f) {
        auto timer = std::make_shared<asio::steady_timer>(acceptor.get_executor(), std::chrono::milliseconds(100));
        timer->async_wait([timer, &acceptor, f = std::forward<F>(f)](ErrorCode) mutable {
            if (acceptor.is_open()) accept(acceptor, std::move(f));
        });
    }
};

/// Throws Error{input} for files that are no certificate or key.
inline asio::ssl::context tls_context(const ServerSettings& settings) {
    asio::ssl::context context(asio::ssl::context::tls_server);
    context.set_options(asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1);
    ErrorCode failed;
    context.use_certificate_chain_file(settings.certificate, failed);
    if (failed) throw Error(ErrorKind::input, "is no certificate in PEM form: " + failed.message(), settings.certificate);
    context.use_private_key_file(settings.key, asio::ssl::context::pem, failed);
    if (failed) throw Error(ErrorKind::input, "is not the certificate's key in PEM form: " + failed.message(), settings.key);
    return context;
}

} // namespace clvr::view
