#include "host/dataset/manifest.hpp"
#include "host/dataset/embedded_manifests.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <climits>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {

std::string Dataset::file_name() const { return url.substr(url.find_last_of('/') + 1); }

Dataset parse_manifest(const std::string& text, const std::string& where) {
    try {
        const auto j = nlohmann::json::parse(text);
        Dataset d;
        for (auto [key, to] : {std::pair("name", &d.name),
                               {"title", &d.title},
                               {"source", &d.source},
                               {"licence", &d.licence},
                               {"citation", &d.citation},
                               {"type", &d.type},
                               {"transfer_function", &d.transfer_function},
                               {"computed", &d.computed}})
            j.at(key).get_to(*to);
        d.url = j.value("url", "");
        const auto bytes = j.value("bytes", nlohmann::json(0u));
        if (!bytes.is_number_unsigned()) throw Error(ErrorKind::internal, "has bytes that are no whole number", where);
        d.bytes = bytes.get<std::uint64_t>();
        d.sha512 = j.value("sha512", "");
        for (const auto& n : j.at("dims"))
            if (!n.is_number_unsigned() || n.get<std::uint64_t>() > INT_MAX)
                throw Error(ErrorKind::internal, "has dims that are no whole numbers", where);
        j.at("dims").get_to(d.dims);
        j.at("spacing").get_to(d.spacing);
        const auto& view = j.at("view");
        d.azimuth = view.at("azimuth").get<double>();
        d.elevation = view.at("elevation").get<double>();
        d.zoom = view.at("zoom").get<double>();
        if (!d.url.empty() && d.bytes == 0) throw Error(ErrorKind::internal, "has a url, and no bytes", where);
        return d;
    } catch (const nlohmann::json::exception& e) {
        throw Error(ErrorKind::internal, fmt::format("is no manifest: {}", e.what()), where);
    }
}

const std::vector<Dataset>& datasets() {
    static const std::vector<Dataset> all = [] {
        std::vector<Dataset> list;
        for (const auto& [name, text] : embedded_manifests()) list.push_back(parse_manifest(text, name));
        return list;
    }();
    return all;
}

const Dataset& dataset_named(const std::string& name) {
    const auto& all = datasets();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Dataset& d) { return d.name == name; });
    if (found != all.end()) return *found;
    std::string names;
    for (const Dataset& d : all) names += (names.empty() ? "" : ", ") + d.name;
    throw Error(ErrorKind::usage, fmt::format("there is no such dataset; there are: {}", names), name);
}

const Dataset* published_as(const std::string& computed) {
    for (const Dataset& d : datasets())
        if (!d.computed.empty() && d.computed == computed) return &d;
    return nullptr;
}

} // namespace clvr
