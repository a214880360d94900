// `clvr view` as a user starts it.
#include "host/io/picture/frame_file.hpp"
#include "tests/cli/home.hpp"
#include "tests/view/serving.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <sys/stat.h>

namespace clvr::view {
namespace {

using testing::HasSubstr;

class ViewProgram : public Program {
protected:
    const std::string out = (home.path() / "saved").string(), token_file = (home.path() / "token").string();

    ViewProgram() { std::filesystem::create_directory(out); }

    /// Starts it, and waits until it serves; which without stored kernels may take more than a minute.
    Child begin(std::vector<std::string> options, const Environment& environment = {}) {
        const std::vector<std::string> always{"view",         ball(),         "--size",   "64x64",        "--spp", "4",
                                              "--no-browser", "--token-file", token_file, "--output-dir", out};
        options.insert(options.begin(), always.begin(), always.end());
        Child child = start(options, environment);
        for (int k = 0; k < 12000 && said().find("#token=") == std::string::npos; ++k)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        const std::string text = test::bytes_of(token_file);
        token = text.substr(0, text.find('\n'));
        return child;
    }
    /// What it printed.
    std::string said() const {
        std::string all;
        for (const auto& file : files(".")) {
            const std::string name = file.filename().string();
            if (name.compare(0, 3, "out") == 0 && name.find('.') == name.npos) all += test::bytes_of(file.string());
        }
        return all;
    }
    int port() const {
        const std::string text = said();
        const std::size_t at = text.find("http://127.0.0.1:");
        return at == text.npos ? 0 : std::stoi(text.substr(at + 17));
    }
    template <class Address>
    Page join(const Address& address, json& hello) const {
        Page page(address);
        page.say(json{{"type", "hello"}, {"token", token}, {"role", "control"}});
        hello = page.next_of("hello", 60000);
        return page;
    }
    static json finished(Page& page) {
        for (;;) {
            const json job = page.next_of("job", 60000);
            if (job.is_null() || (job["state"] != "waiting" && job["state"] != "running")) return job;
        }
    }
    std::string token;
};

std::string settled(Page& page) {
    for (;;) {
        const Page::Message m = page.next(60000);
        if (m.code < 0 || m.code == 8) return {};
        if (m.code != 2) continue;
        page.acknowledge(m);
        if (m.bytes[30] == 2) return m.bytes.substr(32);
    }
}

TEST_F(ViewProgram, SavesThePictureThatRenderMakes) {
    Child child = begin({});
    ASSERT_GT(port(), 0) << child.err();
    json hello;
    Page page = join(port(), hello);
    EXPECT_FALSE(hello["device"].get<std::string>().empty());
    json scene = hello["scene"];
    for (const char* part : {"eye", "target", "up"}) scene["camera"][part] = hello["view"][part];
    scene["width"] = 80;
    page.say(json{{"type", "scene"}, {"generation", 2}, {"scene", scene}});
    std::string shown;
    do shown = settled(page);
    while (!shown.empty() && (shown.size() < 24 || static_cast<unsigned char>(shown[19]) != 80)); // the PNG's width

    for (const char* format : {"png", "jpg"}) {
        page.say(json{{"type", "save"}, {"id", 1}, {"what", "still"}, {"format", format}});
        EXPECT_EQ(finished(page)["state"], "done") << format;
    }
    page.say(json{{"type", "save"}, {"id", 2}, {"what", "scene"}});
    EXPECT_EQ(finished(page)["state"], "done");
    kill(child.pid(), SIGINT);
    EXPECT_EQ(child.wait().exit_code, 0);

    const std::string stem = out + "/ball_16x16x16_uint8", again = (home.path() / "again").string();
    const Outcome o = run({"render", stem + "_scene.json", "-o", again + ".png", "-o", again + ".jpg", "--denoise"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_TRUE(test::bytes_of(stem + ".png") == test::bytes_of(again + ".png"));
    EXPECT_TRUE(test::bytes_of(stem + ".jpg") == test::bytes_of(again + ".jpg"));
    test::put(again + "_shown.png", shown); // what was seen has the same pixels
    EXPECT_EQ(read_png(again + "_shown.png").channels, read_png(again + ".png").channels);
}

TEST_F(ViewProgram, KeepsItsTokenToItself) {
    Child child = begin({});
    struct stat found {};
    ASSERT_EQ(stat(token_file.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0600u);
    EXPECT_GE(token.size(), 32u);
    EXPECT_THAT(test::bytes_of("/proc/" + std::to_string(child.pid()) + "/cmdline"), testing::Not(HasSubstr(token)));
    EXPECT_THAT(said(), HasSubstr("ssh -L "));
    const Outcome second = run({"-q", "view", ball(), "--no-browser", "--port", std::to_string(port())});
    EXPECT_EQ(second.exit_code, 2);
    EXPECT_EQ(line_count(second.err), 1) << second.err;
    EXPECT_THAT(second.err, HasSubstr("--port"));
    kill(child.pid(), SIGTERM);
    EXPECT_EQ(child.wait().exit_code, 0);
}

TEST_F(ViewProgram, RemovesItsSocketOnCtrlC) {
    const std::string socket = (home.path() / "private/view.sock").string();
    Child child = begin({"--socket", socket});
    EXPECT_THAT(said(), HasSubstr("ssh -L 8080:" + socket));
    json hello;
    Page page = join(socket, hello);
    page.say(json{{"type", "save"}, {"id", 1}, {"what", "turntable"}, {"views", 720}, {"samples", 65536}});
    page.next_of("job");
    kill(child.pid(), SIGINT); // while it saves
    EXPECT_THAT(page.next_of("bye", 60000)["message"], HasSubstr("has ended"));
    EXPECT_EQ(child.wait().exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(socket));
    EXPECT_TRUE(files("saved").empty());
}

TEST_F(ViewProgram, EndsWhenNobodyIsThere) {
    Child child = begin({"--idle-timeout", "0.2"});
    EXPECT_EQ(child.wait().exit_code, 0);
}

TEST_F(ViewProgram, OpensTheBrowserWithoutTheTokenOnItsCommandLine) {
    home.write("bin/xdg-open", "#!/bin/sh\necho \"$@\" > \"$HOME/opened\"\n");
    chmod((home.path() / "bin/xdg-open").c_str(), 0755);
    Child child = start({"view", ball(), "--size", "64x64"},
                        {{"DISPLAY", ":0"}, {"PATH", (home.path() / "bin").string() + ":" + std::getenv("PATH")}});
    const std::string opened = (home.path() / "opened").string();
    for (int k = 0; k < 12000 && test::bytes_of(opened).find('\n') == std::string::npos; ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::string page = test::bytes_of(opened);
    page = page.substr(0, page.find('\n'));
    struct stat found {};
    ASSERT_EQ(stat(page.c_str(), &found), 0) << page;
    EXPECT_EQ(found.st_mode & 0777, 0600u);
    EXPECT_THAT(test::bytes_of(page), HasSubstr("http://127.0.0.1:" + std::to_string(port()) + "/#token="));
    kill(child.pid(), SIGINT);
    EXPECT_EQ(child.wait().exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(page));
}

TEST_F(ViewProgram, RefusesBeforeItServes) {
    const auto refusal = [&](const std::vector<std::string>& options, int exit_code) {
        std::vector<std::string> words{"view", "--no-browser"};
        words.insert(words.end(), options.begin(), options.end());
        const Outcome o = run(words);
        EXPECT_EQ(o.exit_code, exit_code) << o.err;
        EXPECT_EQ(o.out, "");
        EXPECT_EQ(line_count(o.err), 1) << o.err;
        return o.err;
    };
    EXPECT_THAT(refusal({}, 2), HasSubstr("no volume given"));
    EXPECT_THAT(refusal({"nothing.nii"}, 3), HasSubstr("nothing.nii"));
    EXPECT_THAT(refusal({ball(), "--host", "0.0.0.0"}, 2), HasSubstr("--insecure"));
    EXPECT_THAT(refusal({ball(), "--cert", ball()}, 2), HasSubstr("belong together"));
    EXPECT_THAT(refusal({ball(), "--base-url", "x"}, 2), HasSubstr("--base-url"));
    EXPECT_THAT(refusal({ball(), "--port", "70000"}, 2), HasSubstr("--port"));
    EXPECT_THAT(refusal({ball(), "--output-dir", "none"}, 2), HasSubstr("--output-dir"));
    EXPECT_THAT(refusal({ball(), "--idle-timeout", "-1"}, 2), HasSubstr("--idle-timeout"));
}

} // namespace
} // namespace clvr::view
