#include "host/view/address.hpp"
#include "host/view/token.hpp"
#include "runtime/error.hpp"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace clvr::view {

namespace {

constexpr int usual_tunnel_port = 8080;

std::string authority(const std::string& host, int port) {
    return host.find(':') == host.npos ? fmt::format("{}:{}", host, port) : fmt::format("[{}]:{}", host, port);
}

bool is_wildcard(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

} // namespace

void check_address(const ServerSettings& settings, bool insecure) {
    if (settings.certificate.empty() != settings.key.empty())
        throw Error(ErrorKind::usage, "a certificate and its key belong together", "--cert, --cert-key");
    if (!settings.base_url.empty()) parse_base_url(settings.base_url);
    if (settings.socket.empty() && !is_loopback(settings.host) && settings.certificate.empty() && !insecure)
        throw Error(
            ErrorKind::usage,
            fmt::format("is {}, which other machines reach, and what they are sent could be read on the way: add --cert and --cert-key, or "
                        "--insecure; or leave it out and use the ssh tunnel that is printed then",
                        settings.host),
            "--host");
}

Whereabouts whereabouts(const ServerSettings& settings, int port, const std::string& user, const std::string& machine) {
    const std::string scheme = settings.certificate.empty() ? "http://" : "https://", fragment = "/#token=" + settings.token;
    const std::string login = user.empty() ? machine : user + "@" + machine;
    Whereabouts to;
    if (!settings.socket.empty()) {
        const int tunnel_port = settings.port > 0 ? settings.port : usual_tunnel_port;
        to.url = scheme + authority("localhost", tunnel_port) + fragment;
        to.tunnel = fmt::format("ssh -L {}:{} {}", tunnel_port, std::filesystem::absolute(settings.socket).string(), login);
    } else {
        to.url = scheme + authority(is_wildcard(settings.host) ? machine : settings.host, port) + fragment;
        if (is_loopback(settings.host)) to.tunnel = fmt::format("ssh -L {0}:{1} {2}", port, authority(settings.host, port), login);
    }
    if (!settings.base_url.empty()) {
        const BaseUrl base = parse_base_url(settings.base_url);
        to = {base.scheme + "://" + base.authority + base.path + fragment, {}};
    }
    return to;
}

std::string leading_page(const std::string& url) {
    return "<!doctype html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n<title>clvr</title>\n"
           "<meta http-equiv=\"refresh\" content=\"0; url=" +
           url + "\">\n<p><a href=\"" + url + "\">Open the viewer</a></p>";
}

bool open_browser(const std::string& url, const std::string& folder) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return false;
    const std::string page = folder + "/open.html";
    write_token_file(page, leading_page(url));

    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK); // Ctrl-C is not the browser's
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", stream == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);

    std::string program = "xdg-open", argument = page;
    char* const arguments[]{program.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int failed = posix_spawnp(&child, program.c_str(), &actions, &attributes, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return failed == 0;
}

} // namespace clvr::view
