// Where a viewer is found, as its user is told.
#pragma once
#include "host/view/server.hpp"

#include <string>

namespace clvr::view {

/// Throws Error{usage}: an address that other machines reach, without TLS and without `insecure`; a base URL that is none; half of a
/// certificate.
void check_address(const ServerSettings& settings, bool insecure);

struct Whereabouts {
    std::string url;    ///< with the token in its fragment, which browsers do not send
    std::string tunnel; ///< the ssh command for another machine, after which the URL is good there; empty where none is needed
};
/// `port`: what the server has. `user` and `machine`: for ssh.
Whereabouts whereabouts(const ServerSettings& settings, int port, const std::string& user, const std::string& machine);

/// Text of a page that leads to the URL: browsers take its file's path, as command lines can be seen by every user of a machine.
std::string leading_page(const std::string& url);
/// Opens the page in the user's browser where there is a display; it lies in `folder` as long as that is there. False: there is no display,
/// or no program that opens pages.
bool open_browser(const std::string& url, const std::string& folder);

} // namespace clvr::view
