// Whom a request may mean and where it may come from.
#include "host/view/hosts.hpp"
#include "host/view/net_text.hpp"
#include "tests/io/frames.hpp"

namespace clvr::view {
namespace {

using test::error_of;

TEST(Hosts, AreReadFromAuthorities) {
    EXPECT_EQ(host_of("LocalHost:8080"), "localhost");
    EXPECT_EQ(host_of("127.0.0.1"), "127.0.0.1");
    EXPECT_EQ(host_of("[::1]:1"), "::1");
    EXPECT_EQ(host_of("[::1]"), "::1");
    for (const char* bad : {"", "a:b", "a:", "a:123456", "[::1", "[x]:1", "user@a", "a/b", "a b", "a\n", "::1", "[::1]x", "a:1:2"})
        EXPECT_EQ(host_of(bad), "") << bad;
    EXPECT_EQ(host_of(std::string(300, 'a')), "");
}

TEST(Hosts, OfThisMachineAreAllowedWithAnyPort) {
    const AllowedHosts hosts("127.0.0.1", "");
    for (const char* good : {"localhost:1", "127.0.0.1:65535", "[::1]:8080", "localhost"}) EXPECT_TRUE(hosts.host(good)) << good;
    // DNS rebinding: the name of another site, whatever address it has.
    for (const char* bad : {"evil.example:8080", "localhost.evil.example", "evil-localhost", "127.0.0.2", "", "null"})
        EXPECT_FALSE(hosts.host(bad)) << bad;
}

TEST(Hosts, ThatWereGivenAreAllowed) {
    const AllowedHosts hosts("10.0.0.7", "https://hub.example.org:8443/user/me/");
    EXPECT_TRUE(hosts.host("10.0.0.7:8080"));
    EXPECT_TRUE(hosts.host("hub.example.org"));
    EXPECT_TRUE(hosts.origin("https://hub.example.org:8443"));
    EXPECT_FALSE(hosts.host("example.org"));
    EXPECT_FALSE(AllowedHosts("0.0.0.0", "").host("0.0.0.0:80"));
}

TEST(Hosts, OfOriginsAreLookedAt) {
    const AllowedHosts hosts("127.0.0.1", "");
    for (const char* good : {"http://localhost:1", "https://127.0.0.1:2", "http://[::1]:3"}) EXPECT_TRUE(hosts.origin(good)) << good;
    for (const char* bad : {"null", "", "localhost", "file://localhost", "http://evil.example", "http://localhost@evil.example",
                            "http://localhost.evil.example", "http://localhost/x", "http://"})
        EXPECT_FALSE(hosts.origin(bad)) << bad;
}

TEST(Hosts, LoopbackIsKnown) {
    for (const char* yes : {"localhost", "127.0.0.1", "127.8.9.10", "::1"}) EXPECT_TRUE(is_loopback(yes)) << yes;
    for (const char* no : {"0.0.0.0", "10.0.0.1", "::", "node17", "128.0.0.1", ""}) EXPECT_FALSE(is_loopback(no)) << no;
}

TEST(Hosts, BaseUrlsHaveThreeParts) {
    const BaseUrl url = parse_base_url("HTTPS://Hub.example.org:8443/user/me/");
    EXPECT_EQ(url.scheme, "https");
    EXPECT_EQ(url.authority, "Hub.example.org:8443");
    EXPECT_EQ(url.path, "/user/me");
    EXPECT_EQ(parse_base_url("http://a").path, "");
    for (const char* bad :
         {"", "a.example", "ftp://a", "http://", "http://a?x", "http://a/?x", "http://a/#x", "http://u@a/", "http://a/\""})
        EXPECT_EQ(error_of([&] { parse_base_url(bad); }).where(), "--base-url") << bad;
}

TEST(NetText, IsEncodedAndCut) {
    EXPECT_EQ(encoded("a b/\xc3\xbc.png"), "a%20b%2F%C3%BC.png");
    EXPECT_EQ(decoded(encoded("a b/\xc3\xbc%41.png")), "a b/\xc3\xbc%41.png");
    EXPECT_EQ(decoded("100%"), "100%");
    EXPECT_EQ(decoded("%4"), "%4");
    EXPECT_EQ(decoded("%zz%41"), "%zzA");
    EXPECT_EQ(cut_utf8("a\xc3\xbc", 2), "a");
    EXPECT_EQ(cut_utf8("a\xc3\xbc", 3), "a\xc3\xbc");
}

} // namespace
} // namespace clvr::view
