#include "host/view/hosts.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>

namespace clvr::view {

namespace {

constexpr std::size_t longest_name = 255;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_character(char c) { return is_digit(c) || (c >= 'a' && c <= 'z') || c == '.' || c == '-' || c == '_'; }

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

bool is_port(const std::string& text) { return !text.empty() && text.size() <= 5 && std::all_of(text.begin(), text.end(), is_digit); }

bool is_ipv6(const std::string& text) {
    in6_addr address{};
    return inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

std::string own_name() {
    std::array<char, longest_name + 1> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? lower(name.data()) : std::string();
}

} // namespace

std::string host_of(const std::string& authority) {
    const std::string text = lower(authority);
    const bool bracketed = text.compare(0, 1, "[") == 0;
    const std::size_t end = bracketed ? text.find(']') : std::min(text.find(':'), text.size());
    if (end == text.npos || end > longest_name) return {};
    const std::string name = bracketed ? text.substr(1, end - 1) : text.substr(0, end);
    const std::string rest = text.substr(bracketed ? end + 1 : end);
    if (!rest.empty() && (rest[0] != ':' || !is_port(rest.substr(1)))) return {};
    if (bracketed) return is_ipv6(name) ? name : std::string();
    return std::all_of(name.begin(), name.end(), is_name_character) ? name : std::string();
}

BaseUrl parse_base_url(const std::string& text) {
    BaseUrl url;
    const std::size_t mark = text.find("://");
    if (mark != text.npos) {
        const std::size_t path = std::min(text.find('/', mark + 3), text.size());
        url = {lower(text.substr(0, mark)), text.substr(mark + 3, path - mark - 3), text.substr(path)};
        while (!url.path.empty() && url.path.back() == '/') url.path.pop_back();
    }
    const bool plain =
        std::all_of(url.path.begin(), url.path.end(), [](char c) { return c > ' ' && c < '\x7f' && !std::strchr("?#\"<>\\", c); });
    if ((url.scheme != "http" && url.scheme != "https") || host_of(url.authority).empty() || !plain)
        throw Error(ErrorKind::usage,
                    fmt::format("is \"{}\"; expected the address of the page, such as https://hub.example.org/view/", text), "--base-url");
    return url;
}

bool is_loopback(const std::string& host) {
    in_addr address{};
    if (inet_pton(AF_INET, host.c_str(), &address) == 1) return ntohl(address.s_addr) >> 24 == 127;
    return host == "localhost" || host == "::1";
}

AllowedHosts::AllowedHosts(const std::string& host, const std::string& base_url) : names_{"localhost", "127.0.0.1", "::1"} {
    names_.insert(host == "0.0.0.0" || host == "::" ? own_name() : lower(host));
    if (!base_url.empty()) names_.insert(host_of(parse_base_url(base_url).authority));
    names_.erase("");
}

bool AllowedHosts::host(const std::string& authority) const { return names_.count(host_of(authority)) > 0; }

bool AllowedHosts::origin(const std::string& text) const {
    for (const char* scheme : {"http://", "https://"}) {
        const std::string start = scheme;
        if (text.compare(0, start.size(), start) == 0) return host(text.substr(start.size()));
    }
    return false;
}

} // namespace clvr::view
