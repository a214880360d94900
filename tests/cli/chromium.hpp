// Debian's chromium without a window, driven over its DevTools protocol: real mouse, wheel, keyboard and touch events.
#pragma once
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace clvr::test {

/// One page. Speaks through pipes (--remote-debugging-pipe): messages are JSON, each ended by a zero. What the browser refuses, and what
/// does not come in time, is thrown.
class Chromium {
public:
    using Json = nlohmann::json;
    static constexpr const char* program = "/usr/bin/chromium";
    static bool installed() { return ::access(program, X_OK) == 0; }

    /// `width`, `height`: of the page [CSS pixels].
    Chromium(int width, int height, double pixel_ratio = 1, bool touch = false) {
        start();
        const Json target = call("Target.createTarget", {{"url", "about:blank"}});
        session_ = call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}}).at("sessionId");
        for (const char* domain : {"Runtime", "Log", "Page"}) call(std::string(domain) + ".enable");
        call("Emulation.setDeviceMetricsOverride",
             {{"width", width}, {"height", height}, {"deviceScaleFactor", pixel_ratio}, {"mobile", touch}});
        if (touch) call("Emulation.setTouchEmulationEnabled", {{"enabled", true}, {"maxTouchPoints", 5}});
        call("Browser.setDownloadBehavior", {{"behavior", "allow"}, {"downloadPath", downloads().string()}});
    }
    Chromium(const Chromium&) = delete;
    Chromium& operator=(const Chromium&) = delete;
    ~Chromium() {
        ::close(to_), ::close(from_);
        ::kill(-pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }

    std::filesystem::path downloads() const { return profile_.path() / "downloads"; }
    /// What the page said in its console as an error, what it threw, and what the browser would not let it do.
    const std::vector<std::string>& complaints() const { return complaints_; }

    void open(const std::string& url) { call("Page.navigate", {{"url", url}}); }
    /// The value of an expression of JavaScript.
    Json value(const std::string& expression) {
        const Json reply = call("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
        if (reply.contains("exceptionDetails")) throw std::runtime_error(expression + ": " + reply.at("exceptionDetails").dump());
        return reply.at("result").value("value", Json());
    }
    /// Whether the expression becomes true within that time.
    bool becomes(const std::string& expression, int seconds = 60) {
        const auto end = Clock::now() + std::chrono::seconds(seconds);
        while (Clock::now() < end) {
            if (value(expression) == true) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        return false;
    }

    enum class Button { none, left, right, middle };
    void mouse(const char* type, double x, double y, Button button = Button::none, int clicks = 0) {
        static constexpr const char* names[] = {"none", "left", "right", "middle"};
        const int at = static_cast<int>(button);
        call("Input.dispatchMouseEvent", {{"type", type},
                                          {"x", x},
                                          {"y", y},
                                          {"button", names[at]},
                                          {"buttons", button == Button::none ? 0
                                                      : at == 3              ? 4
                                                                             : at},
                                          {"clickCount", clicks}});
    }
    void drag(double x0, double y0, double x1, double y1, Button button = Button::left) {
        constexpr int steps = 8;
        mouse("mouseMoved", x0, y0);
        mouse("mousePressed", x0, y0, button, 1);
        for (int k = 1; k <= steps; ++k) mouse("mouseMoved", x0 + (x1 - x0) * k / steps, y0 + (y1 - y0) * k / steps, button);
        mouse("mouseReleased", x1, y1, button, 1);
    }
    void click(double x, double y) {
        mouse("mouseMoved", x, y);
        mouse("mousePressed", x, y, Button::left, 1), mouse("mouseReleased", x, y, Button::left, 1);
    }
    /// In the middle of the element that the expression gives, which is scrolled into view.
    void click(const std::string& element) {
        const Json at = value("(() => { const e = " + element +
                              "; e.scrollIntoView({block: 'center'}); const r = e.getBoundingClientRect();"
                              " return [r.left + r.width / 2, r.top + r.height / 2]; })()");
        click(at.at(0).get<double>(), at.at(1).get<double>());
    }
    void wheel(double x, double y, double by) {
        call("Input.dispatchMouseEvent", {{"type", "mouseWheel"}, {"x", x}, {"y", y}, {"deltaX", 0}, {"deltaY", by}});
    }
    /// `modifiers`: 1 Alt, 2 Ctrl, 4 Meta, 8 Shift. `code`: the virtual key's.
    void key(const std::string& name, int code, int modifiers = 0) {
        Json event{{"type", "keyDown"}, {"key", name}, {"windowsVirtualKeyCode", code}, {"modifiers", modifiers}};
        if (name.size() == 1 && (modifiers & ~8) == 0) event["text"] = name;
        call("Input.dispatchKeyEvent", event);
        event.erase("text");
        event["type"] = "keyUp";
        call("Input.dispatchKeyEvent", event);
    }
    /// Fingers at these places; none: they are lifted.
    void touch(const char* type, const std::vector<std::array<double, 2>>& fingers) {
        Json points = Json::array();
        for (std::size_t k = 0; k < fingers.size(); ++k) points.push_back({{"x", fingers[k][0]}, {"y", fingers[k][1]}, {"id", k}});
        call("Input.dispatchTouchEvent", {{"type", type}, {"touchPoints", points}});
    }
    /// The page as PNG, base64.
    std::string screenshot() { return call("Page.captureScreenshot", {{"format", "png"}}).at("data"); }

    Json call(const std::string& method, const Json& parameters = Json::object()) {
        Json message{{"id", ++calls_}, {"method", method}, {"params", parameters}};
        if (!session_.empty()) message["sessionId"] = session_;
        const std::string text = message.dump() + '\0';
        for (std::size_t sent = 0; sent < text.size();) {
            const ssize_t n = ::write(to_, text.data() + sent, text.size() - sent);
            if (n <= 0) throw std::runtime_error("the browser is gone");
            sent += static_cast<std::size_t>(n);
        }
        for (;;) {
            const Json reply = next(method);
            if (reply.value("id", 0) != calls_) {
                note(reply);
            } else if (reply.contains("error")) {
                throw std::runtime_error(method + ": " + reply.at("error").dump());
            } else {
                return reply.at("result");
            }
        }
    }

private:
    using Clock = std::chrono::steady_clock;
    TemporaryFolder profile_;
    pid_t pid_ = -1;
    int to_ = -1, from_ = -1, calls_ = 0;
    std::string session_, read_;
    std::vector<std::string> complaints_;

    void start() {
        int in[2], out[2];
        if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("no pipes");
        const std::string profile = "--user-data-dir=" + profile_.path().string();
        pid_ = ::fork();
        if (pid_ == 0) {
            ::setpgid(0, 0); // its children end with it
            const int nowhere = ::open("/dev/null", O_RDWR);
            ::dup2(nowhere, 1), ::dup2(nowhere, 2);
            const int reads = ::fcntl(in[0], F_DUPFD, 10), writes = ::fcntl(out[1], F_DUPFD, 10);
            ::dup2(reads, 3), ::dup2(writes, 4); // where the browser expects them
            ::setenv("HOME", profile_.path().c_str(), 1);
            ::execl(program, program, "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars",
                    "--disable-dev-shm-usage", "--remote-debugging-pipe", profile.c_str(), "about:blank", nullptr);
            ::_exit(99);
        }
        ::close(in[0]), ::close(out[1]);
        to_ = in[1], from_ = out[0];
    }

    Json next(const std::string& waiting_for) {
        for (std::size_t end; (end = read_.find('\0')) == std::string::npos;) {
            pollfd wanted{from_, POLLIN, 0};
            char block[1 << 16];
            const ssize_t n = ::poll(&wanted, 1, 60000) > 0 ? ::read(from_, block, sizeof block) : -1;
            if (n <= 0) throw std::runtime_error("the browser does not answer to " + waiting_for);
            read_.append(block, static_cast<std::size_t>(n));
        }
        const std::size_t end = read_.find('\0');
        const std::string text = read_.substr(0, end);
        read_.erase(0, end + 1);
        return Json::parse(text);
    }

    void note(const Json& event) {
        const std::string method = event.value("method", "");
        if (method == "Runtime.exceptionThrown") complaints_.push_back(event.at("params").at("exceptionDetails").dump());
        if (method == "Runtime.consoleAPICalled" && event.at("params").at("type") == "error")
            complaints_.push_back(event.at("params").dump());
        if (method == "Log.entryAdded" && event.at("params").at("entry").at("level") == "error")
            complaints_.push_back(event.at("params").at("entry").dump());
    }
};

} // namespace clvr::test
