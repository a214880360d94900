// Signals that ask the program to end: what is done is saved, nothing temporary stays.
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace clvr {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Signals : public Program {
protected:
    std::string picture = (home.path() / "out" / "head.png").string(), temporary = (home.path() / "tmp").string();

    Signals() {
        fs::create_directory(home.path() / "out");
        fs::create_directory(temporary);
    }

    /// Begins a picture that takes for ever; returns when some of its samples are done, which without stored kernels may take more than a
    /// minute on a busy machine.
    Child begin(const std::function<void()>& prepare = {}, const Environment& more = {}) const {
        Environment environment{{"TMPDIR", temporary}};
        environment.insert(more.begin(), more.end());
        Child child = start({"-v", "render", ball(), "-o", picture, "--size", "32x32", "--spp", "1000000"}, environment, prepare);
        for (int k = 0; k < 15000 && child.err().find("samples per pixel done") == std::string::npos; ++k)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return child;
    }
    void expect_saved(Child& child) const {
        const Outcome o = child.wait();
        EXPECT_EQ(o.exit_code, 130) << o.err;
        EXPECT_THAT(o.err, HasSubstr("clvr: interrupted; saved"));
        EXPECT_EQ(files("out"), std::vector<fs::path>{picture});
        EXPECT_TRUE(fs::is_empty(temporary));
    }
};

TEST_F(Signals, SaveWhatIsDone) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        fs::remove(picture);
        Child child = begin();
        kill(child.pid(), signal);
        expect_saved(child);
    }
}

TEST_F(Signals, OfATerminalThatGoesMayComeTwice) {
    Child child = begin();
    kill(child.pid(), SIGHUP), kill(child.pid(), SIGHUP);
    expect_saved(child);
}

TEST_F(Signals, AreLeftToWhoeverIgnoresThem) {
    Child child = begin([] { std::signal(SIGHUP, SIG_IGN); }); // nohup
    kill(child.pid(), SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(waitpid(child.pid(), nullptr, WNOHANG), 0) << "it still runs";
    kill(child.pid(), SIGTERM);
    expect_saved(child);
}

TEST_F(Signals, TakeTheDriversFolderAlong) {
    Child child = begin({}, {{"POCL_CACHE_DIR", "/proc/nowhere"}, {"XDG_CACHE_HOME", "/proc/nowhere"}}); // its own folder is made in TMPDIR
    EXPECT_FALSE(fs::is_empty(temporary));
    kill(child.pid(), SIGHUP);
    expect_saved(child);
}

TEST_F(Signals, EndWhatSavesNothingAtOnce) {
    Child child = start({"selftest"}, {{"TMPDIR", temporary}, {"POCL_CACHE_DIR", "/proc/nowhere"}, {"XDG_CACHE_HOME", "/proc/nowhere"}});
    for (int k = 0; k < 3000 && fs::is_empty(temporary); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    kill(child.pid(), SIGTERM);
    EXPECT_EQ(child.wait().exit_code, 130);
    for (int k = 0; k < 500 && !fs::is_empty(temporary); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(fs::is_empty(temporary)) << "the selftest's own child cleans up, too";
}

} // namespace
} // namespace clvr
