// WebSockets: who gets one, and what ends one.
#include "tests/view/serving.hpp"

#include <gmock/gmock.h>

namespace clvr::view {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Socket : public Serving {};

TEST_F(Socket, NeedsAnAllowedOrigin) {
    const int port = start();
    for (const char* origin : {"", "Origin: null\r\n", "Origin: http://evil.example\r\n", "Origin: http://localhost:1\r\nOrigin: null\r\n"})
        EXPECT_EQ(Page(port, origin).status(), 403) << origin;
    EXPECT_EQ(Page(port, "Origin: https://127.0.0.1:77\r\n").status(), 101);
}

TEST_F(Socket, JoinsWithTheToken) {
    Page page = joined(start(), "watch");
    EXPECT_TRUE(notes.has("joined 1 watch"));
    page.say(json{{"type", "take_control"}});
    EXPECT_TRUE(notes.has("said 1 4"));
    page.close();
    EXPECT_TRUE(notes.has("left 1"));
}

TEST_F(Socket, EndsWithoutTheToken) {
    const int port = start();
    for (const char* first : {R"({"type":"hello","token":"secrex","role":"control"})", R"({"type":"hello","token":""})",
                              R"({"type":"take_control"})", R"({"type":"save","id":1,"what":"still"})"}) {
        Page page(port);
        page.say(std::string(first));
        EXPECT_THAT(page.close_reason(), StartsWith("1008 message")) << first;
    }
    EXPECT_EQ(notes.count(""), 0);
}

TEST_F(Socket, EndsWhenTheTokenIsNotSaidInTime) {
    settings.authenticate_s = 0.1;
    Page page(start());
    EXPECT_EQ(page.close_reason(), "1008 the token was not said in time");
}

TEST_F(Socket, OnlyOneThatJoinedIsSentAnything) {
    Page stranger(start()), friendly = joined(server->port());
    server->send_all("a text");
    server->show_all(picture(1, 10));
    EXPECT_EQ(friendly.next().bytes, "a text");
    EXPECT_EQ(friendly.next().code, 2);
    EXPECT_EQ(stranger.next(200).code, -1);
}

TEST_F(Socket, BadInputClosesThatClientAlone) {
    const int port = start();
    Page good = joined(port);
    const auto expect_closed = [&](const char* code, const std::function<void(Page&)>& misbehave) {
        Page page = joined(port);
        misbehave(page);
        EXPECT_THAT(page.close_reason(), StartsWith(code));
        EXPECT_TRUE(page.connection().closes());
    };
    expect_closed("1008", [](Page& p) { p.say(std::string("no json")); });
    expect_closed("1008", [](Page& p) { p.say(std::string(R"({"type":"format_disk"})")); });
    expect_closed("1008", [](Page& p) { p.say(std::string(R"({"type":"ack","number":1,"x":1})")); });
    expect_closed("1008", [](Page& p) { p.say(std::string(R"({"type":"hello","token":"secret"})")); }); // a second one
    expect_closed("1008", [](Page& p) { p.say(std::string(R"({"type":"time_step","step":1})")); });     // the program refuses it
    expect_closed("1011", [](Page& p) { p.say(std::string(R"({"type":"cancel","job":"1"})")); });       // a mistake of the program's own
    expect_closed("1008", [](Page& p) { p.say("[" + std::string(60000, '[')); });
    expect_closed("1008", [](Page& p) { p.frame(0x82, "binary"); });
    expect_closed("1009", [](Page& p) { p.say(std::string(70000, ' ')); });
    expect_closed("1007", [](Page& p) { p.say(std::string("\xff\xfe")); });
    expect_closed("1002", [](Page& p) { p.frame(0xf1, "reserved bits"); });
    expect_closed("1002", [](Page& p) { p.connection().send(std::string("\x81\x01x")); }); // not masked
    expect_closed("1002", [](Page& p) { p.frame(0x83, "no such kind"); });
    expect_closed("1002", [](Page& p) { p.frame(0x80, "goes on with nothing"); });
    {
        Page gone = joined(port);
        gone.connection().send("\x81"); // half a frame
    }
    good.say(json{{"type", "take_control"}});
    EXPECT_TRUE(notes.has("said 1 4"));
}

TEST_F(Socket, TheNinthClientIsRefused) {
    const int port = start();
    std::vector<Page> pages;
    for (std::size_t i = 0; i < most_clients; ++i) pages.push_back(joined(port));
    EXPECT_EQ(Page(port).status(), 503);
    pages.pop_back();
    EXPECT_TRUE(eventually([&] { return Page(port).status() == 101; }));
}

TEST_F(Socket, AHundredReconnectsLoseNothing) {
    const int port = start();
    for (int i = 0; i < 100; ++i) {
        std::optional<Page> page;
        ASSERT_TRUE(eventually([&] { return page.emplace(port).status() == 101; })) << i;
        page->say(json{{"type", "hello"}, {"token", "secret"}});
        EXPECT_EQ(page->next().code, 1);
        server->show_all(picture(static_cast<std::uint32_t>(i), 100));
        EXPECT_EQ(page->next().code, 2);
    }
    EXPECT_TRUE(eventually([&] { return notes.count("left") == 100; }));
}

TEST_F(Socket, AClientThatStopsReadingDelaysNobody) {
    const int port = start();
    Page stuck = joined(port), good = joined(port);
    for (std::uint32_t n = 1; n <= 50; ++n) { // 100 MB in all
        server->show_all(picture(n, 2 << 20));
        Page::Message message = good.next();
        ASSERT_EQ(message.bytes.size(), 8u + (2 << 20)) << n;
        good.acknowledge(message);
    }
    int read = 0;
    for (Page::Message m = stuck.next(300); m.code == 2; m = stuck.next(300)) ++read;
    EXPECT_LE(read, 2); // it acknowledged nothing
}

TEST_F(Socket, TextsForOneThatStopsReadingEndIt) {
    const int port = start();
    Page stuck = joined(port), good = joined(port);
    for (int i = 0; i < 3000 && notes.count("left") == 0; ++i) { // until the system's buffers and the queue's are full
        server->send(1, std::string(100000, 'x'));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(notes.has("left 1"));
    server->send_all("still here");
    EXPECT_EQ(good.next().bytes, "still here");
}

TEST_F(Socket, IsPingedAndCountsAsLostWithoutAnAnswer) {
    settings.ping_s = 0.2;
    const int port = start();
    Page silent = joined(port), good = joined(port);
    EXPECT_EQ(silent.next(5000, false).code, 9);
    for (int i = 0; i < 10 && notes.count("left 1") == 0; ++i) good.next(100);
    EXPECT_TRUE(notes.has("left 1"));
    EXPECT_EQ(notes.count("left 2"), 0);
}

TEST_F(Socket, IsToldWhenTheServerEnds) {
    Page page = joined(start());
    Page unknown(server->port());
    server->stop(R"({"type":"bye"})");
    EXPECT_EQ(page.next().bytes, R"({"type":"bye"})");
    EXPECT_EQ(page.close_reason(), "1001 the viewer ends");
    EXPECT_EQ(unknown.close_reason(), "1001 the viewer ends");
    EXPECT_FALSE(Connection(server->port()).connected());
}

} // namespace
} // namespace clvr::view
