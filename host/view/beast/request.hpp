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

template <class Parser>
bool has_body(const Parser& parser) {
    return parser.chunked() || parser.content_length().value_or(0) > 0;
}

} // namespace clvr::view
