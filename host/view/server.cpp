#include "host/view/server.hpp"
#include "host/view/beast/http_connection.hpp"
#include "host/view/beast/listening.hpp"

#include <boost/asio/strand.hpp>

#include <future>
#include <thread>

namespace clvr::view {

class Server::Network {
public:
    explicit Network(const ServerSettings& settings) : shared_(settings), listening_(shared_.io, settings) {
        if (!settings.certificate.empty()) secure_.emplace(tls_context(settings));
    }
    ~Network() { stop("the viewer ends"); }

    int port() const { return listening_.port(); }

    void start(Handler& handler) {
        shared_.handler = &handler;
        accept();
        thread_ = std::thread([this] { run(); });
    }

    void stop(const std::string& bye) {
        if (!thread_.joinable()) return;
        auto done = std::make_shared<std::promise<void>>();
        post([this, bye, done] {
            listening_.close();
            leave(bye);
            wait_for_clients(20, done);
        });
        done->get_future().wait();
        shared_.io.stop();
        thread_.join();
        shared_.clients.clear();
    }

    template <class F>
    void post(F&& call) {
        asio::post(in_order_, std::forward<F>(call));
    }

    template <class F>
    void to_client(ClientId client, F&& call) {
        post([this, client, call = std::forward<F>(call)] {
            const auto found = shared_.clients.find(client);
            if (found == shared_.clients.end()) return;
            const std::shared_ptr<Client> kept = found->second; // the call may let it go
            if (kept->joined()) call(*kept);
        });
    }
    template <class F>
    void to_all(F&& call) {
        post([this, call = std::forward<F>(call)] {
            for (const auto& [id, client] : std::map(shared_.clients)) // the call may let some go
                if (client->joined()) call(*client);
        });
    }

private:
    static constexpr int most_connections = 64;
    Shared shared_;
    Listening listening_;
    asio::strand<asio::io_context::executor_type> in_order_{
        shared_.io.get_executor()}; // io alone would put calls of its own thread behind others
    std::optional<asio::ssl::context> secure_;
    asio::steady_timer waiting_{shared_.io};
    std::thread thread_;

    void run() {
        for (;;) {
            try {
                shared_.io.run();
                return;
            } catch (const std::exception& e) { // of one client: the others go on
                spdlog::error("the viewer's server: {}", e.what());
            }
        }
    }

    void accept() {
        listening_.accept([this](asio::generic::stream_protocol::socket socket) {
            if (shared_.connections < most_connections) serve(Plain(std::move(socket)));
            accept();
        });
    }

    void serve(Plain&& stream) {
        if (secure_)
            std::make_shared<HttpConnection<Secure>>(Secure(std::move(stream), *secure_), shared_)->begin();
        else
            std::make_shared<HttpConnection<Plain>>(std::move(stream), shared_)->begin();
    }

    void leave(const std::string& bye) {
        const auto text = std::make_shared<const std::string>(bye);
        for (const auto& [id, client] : std::map(shared_.clients)) {
            if (client->joined()) client->text(text, "");
            client->leave("the viewer ends");
        }
    }

    /// Looks every 50 ms, so many times, whether all are gone.
    void wait_for_clients(int looks, const std::shared_ptr<std::promise<void>>& done) {
        if (looks == 0 || shared_.clients.empty()) return done->set_value();
        waiting_.expires_after(std::chrono::milliseconds(50));
        waiting_.async_wait([=](ErrorCode) { wait_for_clients(looks - 1, done); });
    }
};

Server::Server(const ServerSettings& settings) : network_(std::make_unique<Network>(settings)) {}
Server::~Server() = default;
int Server::port() const { return network_->port(); }
void Server::start(Handler& handler) { network_->start(handler); }
void Server::stop(const std::string& bye) { network_->stop(bye); }

void Server::send(ClientId client, std::string text, const std::string& key) {
    auto kept = std::make_shared<const std::string>(std::move(text));
    network_->to_client(client, [=](Client& c) { c.text(kept, key); });
}
void Server::send_all(std::string text, const std::string& key) {
    auto kept = std::make_shared<const std::string>(std::move(text));
    network_->to_all([=](Client& c) { c.text(kept, key); });
}
void Server::show(ClientId client, std::shared_ptr<const EncodedPicture> picture) {
    network_->to_client(client, [=](Client& c) { c.picture(picture); });
}
void Server::show_all(std::shared_ptr<const EncodedPicture> picture) {
    network_->to_all([=](Client& c) { c.picture(picture); });
}

} // namespace clvr::view
