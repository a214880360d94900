// Downloads killed at random moments: the file has its name only when it is whole, and the next download continues.
#include "host/dataset/download.hpp"
#include "tests/dataset/server.hpp"
#include "tests/runtime/kills.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace clvr::testing {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(DownloadKills, LeaveAWholeFileOrAPart) {
    for (const char* name : {"http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY"}) unsetenv(name);
    const TemporaryFolder folder;
    const std::string path = (folder.path() / "volume.raw").string();
    std::string body(std::size_t{24} << 20, '\0');
    for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<char>(i * 2654435761u >> 13);
    Server server([&](const std::string& request) {
        const std::size_t range = request.find("bytes=");
        const std::size_t begin = range == request.npos ? 0 : std::min(body.size(), std::stoul(request.substr(range + 6)));
        const std::string rest = body.substr(begin), length = "Content-Length: " + std::to_string(rest.size()) + "\r\n";
        if (begin == 0) return "HTTP/1.1 200 OK\r\nConnection: close\r\n" + length + "\r\n" + rest;
        return "HTTP/1.1 206 Partial Content\r\nConnection: close\r\nContent-Range: bytes " + std::to_string(begin) + "-" +
               std::to_string(body.size() - 1) + "/" + std::to_string(body.size()) + "\r\n" + length + "\r\n" + rest;
    });
    const auto begin_download = [&] {
        const pid_t child = fork();
        if (child != 0) return child;
        try {
            download({server.url(), path, body.size(), "", 3, 0.01});
        } catch (const std::exception&) {
            _exit(1);
        }
        _exit(0);
    };
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(kill_after(begin_download(), 0) && fs::exists(path));
    download({server.url(), path, body.size(), "", 3, 0.01});
    const double life = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ASSERT_EQ(text_of(path), body);
    for (int k = 0; k < kills(); ++k) {
        if (fs::exists(path)) fs::remove(path);
        kill_after(begin_download(), moment(k) * life);
        if (fs::exists(path)) {
            EXPECT_EQ(text_of(path), body) << "kill " << k;
        } else if (k % 2) { // this time the next download continues
            EXPECT_NO_THROW(download({server.url(), path, body.size(), "", 3, 0.01}));
        }
    }
    download({server.url(), path, body.size(), "", 3, 0.01});
    EXPECT_EQ(text_of(path), body);
    EXPECT_FALSE(fs::exists(path + ".part"));
}

} // namespace
} // namespace clvr::testing
