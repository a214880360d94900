// Who may be meant by a request, and from which page it may come: against DNS rebinding and pages of other sites.
#pragma once
#include <set>
#include <string>

namespace clvr::view {

/// The host of "name:port", "[::1]:port" or either without a port, in lower case; empty where the text is none of these.
std::string host_of(const std::string& authority);

/// Parts of "http://name:port/path/".
struct BaseUrl {
    std::string scheme, authority, path; ///< path: begins with '/', ends without
};
/// Throws Error{usage} naming --base-url, unless it is an http or https URL without query, fragment and user.
BaseUrl parse_base_url(const std::string& text);

/// Whether the name means this machine alone: localhost, 127.0.0.0/8, ::1.
bool is_loopback(const std::string& host);

/// The names under which a viewer may be asked for. Ports are not looked at: a tunnel changes them.
class AllowedHosts {
public:
    /// The loopback names; the address that the server has (0.0.0.0 and :: stand for this machine's own name); the host of the base URL, if
    /// there is one.
    AllowedHosts(const std::string& host, const std::string& base_url);
    /// Of a request's Host.
    bool host(const std::string& authority) const;
    /// Of a request's Origin: http or https, of an allowed host. "null" is none.
    bool origin(const std::string& text) const;

private:
    std::set<std::string> names_;
};

} // namespace clvr::view
