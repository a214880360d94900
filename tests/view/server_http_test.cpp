// The page's files, downloads and uploads: what is given to whom.
#include "host/view/page_file.hpp"
#include "tests/view/serving.hpp"

#include <gmock/gmock.h>

namespace clvr::view {
namespace {

using testing::HasSubstr;

class Http : public Serving {};

TEST_F(Http, GivesThePageToAnybodyWithStrictHeaders) {
    const int port = start();
    for (const char* target : {"/", "/index.html", "/?x=1"}) {
        Reply reply = request(port, request_text("GET", target));
        EXPECT_EQ(reply.status, 200) << target;
        EXPECT_EQ(reply.body, *page_file("").text);
        EXPECT_EQ(reply.headers["Content-Type"], "text/html; charset=utf-8");
        EXPECT_THAT(reply.headers["Content-Security-Policy"], HasSubstr("default-src 'self'"));
        EXPECT_EQ(reply.headers["X-Content-Type-Options"], "nosniff");
        EXPECT_EQ(reply.headers["Referrer-Policy"], "no-referrer");
        EXPECT_EQ(reply.headers["Cache-Control"], "no-store");
        for (const char* none : {"Set-Cookie", "Access-Control-Allow-Origin", "Server"}) EXPECT_EQ(reply.headers.count(none), 0u) << none;
    }
}

TEST_F(Http, AnswersSeveralRequestsOnOneConnection) {
    Connection connection(start());
    for (int i = 0; i < 3; ++i) {
        connection.send(request_text("GET", "/"));
        EXPECT_EQ(test::reply_of(connection).status, 200);
    }
}

TEST_F(Http, KnowsNoOtherFiles) {
    const int port = start();
    for (const char* target : {"/index", "/../index.html", "/%2e%2e/etc/passwd", "//etc/passwd", "/etc/passwd", "/page/index.html",
                               "/index.html/", "/index.html%00", "http://localhost/", "*", "/saved", "/SOCKET"})
        EXPECT_EQ(request(port, request_text("GET", target)).status, 404) << target;
}

TEST_F(Http, RefusesOtherMethods) {
    const int port = start();
    for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "HEAD", "TRACE"})
        EXPECT_EQ(request(port, request_text(method, "/")).status, 405) << method;
    EXPECT_EQ(request(port, request_text("GET", "/environment")).status, 405);
    EXPECT_EQ(request(port, request_text("POST", "/socket")).status, 405);
    EXPECT_EQ(request(port, request_text("GET", "/", "Content-Length: 3\r\n") + "abc").status, 413);
    EXPECT_EQ(request(port, request_text("GET", "/socket")).status, 426);
}

TEST_F(Http, RefusesOtherHosts) {
    const int port = start();
    for (const char* host : {"evil.example", "evil.example:80", "localhost.evil.example", "127.0.0.1.nip.io", ""})
        for (const char* target : {"/", "/socket", "/saved/1/x", "/nothing"})
            EXPECT_EQ(request(port, request_text("GET", target, authorization, host)).status, 403) << host << target;
    EXPECT_EQ(request(port, request_text("GET", "/", "Host: localhost\r\n")).status, 403); // two of them
    for (const char* host : {"localhost", "127.0.0.1:99", "[::1]:1"})
        EXPECT_EQ(request(port, request_text("GET", "/", "", host)).status, 200) << host;
}

TEST_F(Http, RefusesPagesOfOtherSites) {
    const int port = start();
    for (const char* origin : {"null", "http://evil.example", "file://", ""})
        for (const char* target : {"/", "/saved/1/x"})
            EXPECT_EQ(request(port, request_text("GET", target, "Origin: " + std::string(origin) + "\r\n")).status, 403) << origin;
    EXPECT_EQ(request(port, request_text("GET", "/", own_origin)).status, 200);
}

TEST_F(Http, IsFoundBelowTheBaseUrlOrWithoutIt) {
    settings.base_url = "https://hub.example.org/user/me/";
    const int port = start();
    EXPECT_EQ(request(port, request_text("GET", "/user/me/", "", "hub.example.org")).status, 200);
    EXPECT_EQ(request(port, request_text("GET", "/", "Origin: https://hub.example.org\r\n")).status, 200);
    EXPECT_EQ(request(port, request_text("GET", "/user/meindex.html")).status, 404);
}

TEST_F(Http, MalformedRequestsEndTheirConnectionAlone) {
    const int port = start();
    for (const std::string& text :
         {std::string("nonsense\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"), std::string("\0\1\2\r\n\r\n", 7),
          request_text("GET", "/", "X: " + std::string(100000, 'x') + "\r\n")}) {
        Connection connection(port);
        connection.send(text);
        EXPECT_TRUE(connection.closes()) << text.substr(0, 20);
    }
    EXPECT_EQ(request(port, request_text("GET", "/")).status, 200);
}

TEST_F(Http, SlowHeadersTimeOut) {
    settings.header_s = 0.1;
    Connection silent(start()), half(server->port());
    half.send("GET / HTTP/1.1\r\nHost: loc");
    EXPECT_TRUE(silent.closes());
    EXPECT_TRUE(half.closes());
}

TEST_F(Http, DownloadsNeedTheToken) {
    test::put(folder / "secret name", "the picture");
    notes.file = SavedFile{folder / "secret name", "b\xc3\xbcro \"1\".png"};
    const int port = start();
    const std::string target = "/saved/1/b%C3%BCro%20%221%22.png";
    EXPECT_EQ(request(port, request_text("GET", target)).status, 401);
    EXPECT_EQ(request(port, request_text("GET", target, "Authorization: Bearer secrex\r\n")).status, 401);
    EXPECT_EQ(request(port, request_text("GET", target, "Cookie: token=secret\r\n")).status, 401);
    EXPECT_EQ(request(port, request_text("GET", target + "?token=secret")).status, 401);
    Reply reply = request(port, request_text("GET", target, authorization));
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.body, "the picture");
    EXPECT_EQ(reply.headers["Content-Disposition"], "attachment; filename*=UTF-8''b%C3%BCro%20%221%22.png");
    EXPECT_EQ(reply.headers["X-Content-Type-Options"], "nosniff");
    for (const char* other : {"/saved/2/b", "/saved/1/", "/saved/1", "/saved/1/../x", "/saved//etc/passwd"})
        EXPECT_EQ(request(port, request_text("GET", other, authorization)).status, 404) << other;
}

TEST_F(Http, LargeDownloadsArriveWhole) {
    std::string bytes(20 << 20, 'x');
    for (std::size_t i = 0; i < bytes.size(); i += 4096) bytes[i] = static_cast<char>(i >> 12);
    test::put(folder / "a", bytes);
    notes.file = SavedFile{folder / "a", "a"};
    EXPECT_TRUE(request(start(), request_text("GET", "/saved/1/a", authorization)).body == bytes);
}

class Upload : public Serving {
protected:
    static std::string text(std::size_t size, const std::string& more) {
        return request_text("POST", "/environment?name=sky%20one.hdr", more + "Content-Length: " + std::to_string(size) + "\r\n");
    }
    Upload() { notes.upload_place = folder / "upload"; }
};

TEST_F(Upload, IsPutWhereTheProgramSays) {
    const std::string bytes(300000, 'h');
    Reply reply = request(start(), text(bytes.size(), authorization + own_origin) + bytes);
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.body, R"({"environment":"upload-1"})");
    EXPECT_TRUE(notes.has("upload sky one.hdr 300000"));
    EXPECT_TRUE(test::bytes_of(notes.upload_place) == bytes);
}

TEST_F(Upload, IsRefused) {
    settings.upload_bytes = 1000;
    const int port = start();
    EXPECT_EQ(request(port, text(10, "") + "0123456789").status, 401);
    EXPECT_EQ(request(port, text(10, authorization + "Origin: null\r\n") + "0123456789").status, 403);
    EXPECT_EQ(request(port, text(1001, authorization)).status, 413);
    EXPECT_EQ(request(port, text(std::size_t{1} << 60, authorization)).status, 413);
    EXPECT_EQ(request(port, request_text("POST", "/environment", authorization + "Transfer-Encoding: chunked\r\n")).status, 411);
    notes.upload_place.clear();
    EXPECT_EQ(request(port, text(10, authorization) + "0123456789").status, 409);
    EXPECT_EQ(notes.count("upload"), 0);
}

TEST_F(Upload, ThatBreaksOffIsForgotten) {
    {
        Connection connection(start());
        connection.send(text(1000, authorization) + "half");
        EXPECT_TRUE(eventually([&] { return std::filesystem::exists(notes.upload_place); }));
    }
    EXPECT_TRUE(notes.has("upload failed"));
}

} // namespace
} // namespace clvr::view
