// What the user is told of where the viewer is.
#include "host/view/address.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>

namespace clvr::view {
namespace {

using test::error_of;
using testing::HasSubstr;
using testing::Not;

ServerSettings settings_of(const std::string& host = "127.0.0.1") {
    ServerSettings settings;
    settings.host = host, settings.token = "abc";
    return settings;
}

TEST(WhereTheViewerIs, OnThisMachineWithATunnel) {
    const Whereabouts to = whereabouts(settings_of(), 8123, "me", "node17");
    EXPECT_EQ(to.url, "http://127.0.0.1:8123/#token=abc"); // in the fragment, which browsers do not send
    EXPECT_EQ(to.tunnel, "ssh -L 8123:127.0.0.1:8123 me@node17");
    EXPECT_EQ(whereabouts(settings_of("::1"), 8123, "", "node17").tunnel, "ssh -L 8123:[::1]:8123 node17");
}

TEST(WhereTheViewerIs, BehindASocket) {
    ServerSettings settings = settings_of();
    settings.socket = "/home/me/.clvr/view.sock";
    EXPECT_EQ(whereabouts(settings, 0, "me", "node17").url, "http://localhost:8080/#token=abc");
    EXPECT_EQ(whereabouts(settings, 0, "me", "node17").tunnel, "ssh -L 8080:/home/me/.clvr/view.sock me@node17");
    settings.port = 9000; // that of the other machine
    EXPECT_EQ(whereabouts(settings, 0, "me", "node17").tunnel, "ssh -L 9000:/home/me/.clvr/view.sock me@node17");
}

TEST(WhereTheViewerIs, ForOtherMachines) {
    ServerSettings settings = settings_of("0.0.0.0");
    settings.certificate = settings.key = "x.pem";
    const Whereabouts to = whereabouts(settings, 443, "me", "node17");
    EXPECT_EQ(to.url, "https://node17:443/#token=abc");
    EXPECT_EQ(to.tunnel, "");
    settings.base_url = "https://hub.example.org/view/";
    EXPECT_EQ(whereabouts(settings, 443, "me", "node17").url, "https://hub.example.org/view/#token=abc");
}

TEST(WhereTheViewerIs, LoopbackUnlessOneInsists) {
    EXPECT_EQ(ServerSettings().host, "127.0.0.1");
    for (const char* host : {"127.0.0.1", "localhost", "::1"}) EXPECT_NO_THROW(check_address(settings_of(host), false)) << host;
    ServerSettings open = settings_of("0.0.0.0");
    const Error e = error_of([&] { check_address(open, false); });
    EXPECT_EQ(e.where(), "--host");
    EXPECT_THAT(e.line(), HasSubstr("--insecure"));
    EXPECT_NO_THROW(check_address(open, true));
    open.certificate = "cert.pem";
    EXPECT_THAT(error_of([&] { check_address(open, true); }).line(), HasSubstr("belong together"));
    open.key = "key.pem";
    EXPECT_NO_THROW(check_address(open, false));
}

TEST(WhereTheViewerIs, ThePageThatLeadsThereLoadsNothing) {
    const std::string page = leading_page("http://127.0.0.1:1/#token=abc");
    EXPECT_THAT(page, HasSubstr("content=\"0; url=http://127.0.0.1:1/#token=abc\""));
    EXPECT_THAT(page, HasSubstr("no-referrer"));
    EXPECT_THAT(page, Not(HasSubstr("<script")));
}

} // namespace
} // namespace clvr::view
