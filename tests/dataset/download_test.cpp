#include "host/dataset/download.hpp"
#include "host/dataset/embedded_manifests.hpp"
#include "host/dataset/manifest.hpp"
#include "runtime/error.hpp"
#include "tests/dataset/server.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace clvr::testing {
namespace {

using ::testing::HasSubstr;

const std::string sha512_of_abc = "ddaf35a193617abacc417349ae20413112e6fa4e89a97ea20a9eeee64b55d39a2192992a274fc1a836ba3c23a3feebbd454d4423"
                                  "643ce80e2a9ac94fa54ca49f"; // FIPS 180-4

std::string reply(const std::string& status, const std::string& headers, const std::string& body) {
    return "HTTP/1.1 " + status + "\r\nConnection: close\r\n" + headers + "\r\n" + body;
}
std::string whole(const std::string& body) { return reply("200 OK", "Content-Length: " + std::to_string(body.size()) + "\r\n", body); }

class Downloads : public ::testing::Test {
protected:
    Downloads() {
        for (const char* name : {"http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY"}) unsetenv(name);
    }
    TemporaryFolder folder;
    std::string path() const { return (folder.path() / "volume.raw").string(); }
    Download of(const std::string& url, std::uint64_t bytes, const std::string& sha512 = "") const {
        return {url, path(), bytes, sha512, 3, 0.01};
    }
    static std::string text(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// The error's line; nothing but a part may be left.
    std::string refused(const Download& what) const {
        try {
            download(what);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
            EXPECT_FALSE(std::filesystem::exists(what.path));
            return e.line();
        }
        ADD_FAILURE() << "not refused";
        return "";
    }
    bool part() const { return std::filesystem::exists(path() + ".part"); }
};

TEST_F(Downloads, FetchesVerifiesAndAsksOnce) {
    Server server([](const std::string&) { return whole("abc"); });
    std::uint64_t seen = 0;
    download(of(server.url(), 3, sha512_of_abc), [&](std::uint64_t there) { seen = there; });
    EXPECT_EQ(text(path()), "abc");
    EXPECT_EQ(seen, 3u);
    EXPECT_FALSE(part());
    download(of(server.url(), 3, sha512_of_abc));
    EXPECT_EQ(server.requests().size(), 1u);
}

TEST_F(Downloads, GoesOnWhereTheConnectionBroke) {
    std::string body(100000, 'x');
    for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<char>(i * 31 % 251);
    Server server([&](const std::string& request) {
        const std::size_t range = request.find("Range: bytes=");
        if (range == request.npos) return reply("200 OK", "Content-Length: 100000\r\n", body.substr(0, 40000)); // and drops it
        const std::size_t from = std::stoul(request.substr(range + 13));
        return reply("206 Partial Content",
                     "Content-Range: bytes " + std::to_string(from) + "-99999/100000\r\nContent-Length: " + std::to_string(100000 - from) +
                         "\r\n",
                     body.substr(from));
    });
    download(of(server.url(), 100000));
    EXPECT_EQ(text(path()), body);
    ASSERT_EQ(server.requests().size(), 2u);
    EXPECT_THAT(server.requests()[1], HasSubstr("Range: bytes=40000-"));
}

TEST_F(Downloads, BeginsAgainWhereRangesAreUnknown) {
    folder.write("volume.raw.part", "a");
    Server server([](const std::string&) { return whole("abc"); });
    download(of(server.url(), 3, sha512_of_abc));
    EXPECT_EQ(text(path()), "abc");
}

TEST_F(Downloads, RemovesWhatIsCorrupt) {
    Server server([](const std::string&) { return whole("abd"); });
    EXPECT_THAT(refused(of(server.url(), 3, sha512_of_abc)), HasSubstr("checksum"));
    EXPECT_FALSE(part());
}

TEST_F(Downloads, KeepsAPartOfWhatStaysShort) {
    Server server([](const std::string& request) {
        return request.find("Range:") == request.npos ? reply("200 OK", "", "ab")
                                                      : reply("206 Partial Content", "Content-Range: bytes 2-2/3\r\n", "");
    });
    EXPECT_THAT(refused(of(server.url(), 3)), ::testing::AllOf(HasSubstr("3 attempts"), HasSubstr("sent 2 of 3 bytes")));
    EXPECT_TRUE(part());
}

TEST_F(Downloads, RefusesMoreThanExpected) {
    Server server([](const std::string&) { return whole(std::string(5000, 'y')); });
    EXPECT_THAT(refused(of(server.url(), 3)), HasSubstr("more than the 3 bytes"));
    EXPECT_FALSE(part());
    Server liar([](const std::string&) { return reply("200 OK", "Content-Length: 3\r\n", "abcdefgh"); });
    download(of(liar.url(), 3, sha512_of_abc)); // what it says counts
}

TEST_F(Downloads, SaysWhatTheServerAnswered) {
    Server missing([](const std::string&) { return reply("404 Not Found", "Content-Length: 0\r\n", ""); });
    EXPECT_THAT(refused(of(missing.url(), 3)), HasSubstr("404"));
    EXPECT_EQ(missing.requests().size(), 1u);
    Server busy([](const std::string&) { return reply("503 Service Unavailable", "Content-Length: 0\r\n", ""); });
    EXPECT_THAT(refused(of(busy.url(), 3)), HasSubstr("503"));
    EXPECT_EQ(busy.requests().size(), 3u);
    EXPECT_THAT(refused(of("http://127.0.0.1:1/x", 3)), HasSubstr("3 attempts"));
    EXPECT_FALSE(refused(of("file:///etc/hostname", 3)).empty());
}

TEST_F(Downloads, FollowsRedirections) {
    Server server([](const std::string& request) {
        return request.find("/moved") == request.npos ? reply("302 Found", "Location: /moved\r\nContent-Length: 0\r\n", "") : whole("abc");
    });
    download(of(server.url(), 3, sha512_of_abc));
    EXPECT_EQ(text(path()), "abc");
    Server circle([](const std::string&) { return reply("302 Found", "Location: /\r\nContent-Length: 0\r\n", ""); });
    std::filesystem::remove(path());
    EXPECT_FALSE(refused(of(circle.url(), 3)).empty());
}

TEST_F(Downloads, AsksTheProxy) {
    Server proxy([](const std::string&) { return whole("abc"); });
    setenv("http_proxy", proxy.url("").c_str(), 1);
    download(of("http://volumes.invalid/a.raw", 3, sha512_of_abc));
    unsetenv("http_proxy");
    ASSERT_EQ(proxy.requests().size(), 1u);
    EXPECT_THAT(proxy.requests()[0], HasSubstr("GET http://volumes.invalid/a.raw"));
}

TEST_F(Downloads, NeverOverwritesAnotherFile) {
    folder.write("volume.raw", "mine");
    EXPECT_THROW(download(of("http://127.0.0.1:1/x", 3)), Error);
    EXPECT_EQ(text(path()), "mine");
    const std::atomic<bool> cancelled{true};
    std::filesystem::remove(path());
    Server server([](const std::string&) { return whole("abc"); });
    try {
        download(of(server.url(), 3), {}, &cancelled);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::interrupted);
    }
}

TEST(Manifests, AreCompleteAndKnownByName) {
    ASSERT_GE(datasets().size(), 9u);
    for (const Dataset& d : datasets()) {
        EXPECT_FALSE(d.title.empty() || d.source.empty() || d.licence.empty() || d.citation.empty()) << d.name;
        EXPECT_TRUE(d.sha512.empty() || d.sha512.size() == 128) << d.name;
        if (!d.url.empty()) {
            const std::uint64_t voxel = d.type == "u16" ? 2 : 1;
            EXPECT_EQ(d.bytes, voxel * d.dims[0] * d.dims[1] * d.dims[2]) << d.name;
        }
    }
    EXPECT_EQ(dataset_named("stag_beetle").file_name(), "stag_beetle_832x832x494_uint16.raw");
    EXPECT_THROW(dataset_named("unicorn"), Error);
    EXPECT_THROW(parse_manifest("{}", "x.json"), Error);
    EXPECT_THROW(parse_manifest("[", "x.json"), Error);
    const std::string sound = embedded_manifests().begin()->second;
    EXPECT_NO_THROW(parse_manifest(sound, "x.json"));
    std::string broken = sound;
    const std::size_t number = broken.find_first_of("0123456789", broken.find("\"dims\""));
    broken.insert(number, "1e300, ");
    EXPECT_THROW(parse_manifest(broken, "x.json"), Error);
}

} // namespace
} // namespace clvr::testing
