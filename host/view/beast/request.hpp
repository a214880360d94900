// What a request asks for, and whether it may.
#pragma once
#include "host/view/beast/common.hpp"
#include "host/view/net_text.hpp"

namespace clvr::view {

/// The parts of a request's target.
struct Target {
    std::string path;  ///< below the base, without the leading '/'; "?" for what is no path
    std::string query; ///< without the '?'

    Target(const Header& request, const std::string& base_path) {
        const std::string text = text_of(request.target());
        const std::size_t mark = std::min(text.find('?'), text.size());
        path = text.substr(0, mark);
        query = text.substr(std::min(mark + 1, text.size()));
        if (!base_path.empty() && path.compare(0, base_path.size() + 1, base_path + "/") == 0) path.erase(0, base_path.size());
        path = path.compare(0, 1, "/") == 0 ? path.substr(1) : "?";
    }
    std::string value(const std::string& name) const {
        const std::string start = name + "=";
        return query.compare(0, start.size(), start) == 0 ? decoded(query.substr(start.size())) : std::string();
    }
};

inline bool host_allowed(const Header& request, const Shared& shared) {
    return request.count(http::field::host) == 1 && shared.allowed.host(text_of(request[http::field::host]));
}

/// A request without Origin is no page's of another site; that of a WebSocket needs one (HttpConnection::upgrade).
inline bool origin_allowed(const Header& request, const Shared& shared) {
    const std::size_t count = request.count(http::field::origin);
    return count == 0 || (count == 1 && shared.allowed.origin(text_of(request[http::field::origin])));
}

inline bool authorized(const Header& request, const Shared& shared) {
    return same_token(text_of(request[http::field::authorization]), "Bearer " + shared.settings.token);
}

/// Whether what was read is no HTTP, rather than that nothing more came.
inline bool is_malformed(ErrorCode failed) {
    return failed.category() == make_error_code(http::error::bad_method).category() && failed != http::error::end_of_stream &&
           failed != http::error::partial_message;
}

/// A refusal for people.
inline std::string words_of(http::status status) {
    switch (status) {
    case http::status::unauthorized:
        return "The token is missing, or is another viewer's.";
    case http::status::forbidden:
        return "The viewer is not to be used under this address, or from this page. Start it with --base-url to allow another one.";
    case http::status::not_found:
        return "There is no such file.";
    case http::status::method_not_allowed:
        return "That cannot be done with this address.";
    case http::status::conflict:
        return "Another image is on its way, or nobody controls the view.";
    case http::status::length_required:
        return "The length of the upload is missing.";
    case http::status::payload_too_large:
        return "That is too large.";
    case http::status::service_unavailable:
        return "As many windows as there may be are open already. Close one.";
    case http::status::insufficient_storage:
        return "There is no room for the upload.";
    default:
        return text_of(http::obsolete_reason(status));
    }
}

template <class Parser>
bool has_body(const Parser& parser) {
    return parser.chunked() || parser.content_length().value_or(0) > 0;
}

} // namespace clvr::view
