// A server with a program behind it that only takes notes.
#pragma once
#include "host/view/server.hpp"
#include "tests/io/frames.hpp"
#include "tests/view/client.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace clvr::view {

using nlohmann::json;
using test::Connection;
using test::Page;
using test::Reply;
using test::request;
using test::request_text;

/// Whether it comes true within 10 seconds.
template <class F>
bool eventually(F&& f) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!f())
        if (std::chrono::steady_clock::now() > end)
            return false;
        else
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return true;
}

/// What happened, as words: "joined 1 control", "said 1 6" (the message's kind), "left 1", "upload NAME SIZE", "upload failed".
class Notes final : public Handler {
public:
    std::string upload_place;
    std::optional<SavedFile> file; ///< at saved/1/...
    Clients* clients = nullptr;    ///< hello is answered through it

    void joined(ClientId client, Role wanted) override {
        note("joined " + std::to_string(client) + " " + name_of(wanted));
        if (clients) clients->send(client, R"({"type":"hello"})");
    }
    void said(ClientId client, const ClientMessage& message) override {
        if (std::holds_alternative<TimeStep>(message)) throw Error(ErrorKind::input, "is refused", "time_step");
        if (std::holds_alternative<Cancel>(message)) throw std::runtime_error("a mistake");
        note("said " + std::to_string(client) + " " + std::to_string(message.index()));
    }
    void left(ClientId client) override { note("left " + std::to_string(client)); }
    std::optional<SavedFile> saved(const std::string& job, const std::string& name) override {
        return file && job == "1" && name == file->name ? file : std::nullopt;
    }
    std::string place_for_upload() override { return upload_place; }
    void uploaded(const std::string& path, const std::string& name, std::function<void(Answer)> answer) override {
        note("upload " + name + " " + std::to_string(std::filesystem::file_size(path)));
        answer({200, R"({"environment":"upload-1"})"});
    }
    void upload_failed(const std::string&) override { note("upload failed"); }

    int count(const std::string& start) const {
        const std::lock_guard<std::mutex> lock(mutex_);
        return static_cast<int>(
            std::count_if(notes_.begin(), notes_.end(), [&](const auto& n) { return n.compare(0, start.size(), start) == 0; }));
    }
    bool has(const std::string& start) const {
        return eventually([&] { return count(start) > 0; });
    }

private:
    mutable std::mutex mutex_;
    std::vector<std::string> notes_;
    void note(const std::string& text) {
        const std::lock_guard<std::mutex> lock(mutex_);
        notes_.push_back(text);
    }
};

class Serving : public testing::Test {
protected:
    test::Folder folder;
    Notes notes;
    ServerSettings settings;
    std::optional<Server> server;

    Serving() { settings.token = "secret"; }
    int start() {
        server.emplace(settings);
        notes.clients = &*server;
        server->start(notes);
        return server->port();
    }
    void TearDown() override { server.reset(); }

    /// A client that has said the token.
    template <class Address>
    static Page joined(const Address& address, const std::string& role = "control") {
        Page page(address);
        page.say(json{{"type", "hello"}, {"token", "secret"}, {"role", role}});
        EXPECT_EQ(page.next().bytes, R"({"type":"hello"})");
        return page;
    }
    static std::shared_ptr<const EncodedPicture> picture(std::uint32_t number, std::size_t bytes) {
        return std::make_shared<const EncodedPicture>(
            EncodedPicture{number, std::string("CLVR") + std::string(reinterpret_cast<const char*>(&number), 4) + std::string(bytes, 'x')});
    }
};

inline const std::string authorization = "Authorization: Bearer secret\r\n", own_origin = "Origin: http://localhost:1\r\n";

} // namespace clvr::view
