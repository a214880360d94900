#include "host/io/picture/exr_names.hpp"
#include "host/frame/channel_mapping.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace clvr {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool has_colour(const ExrPart& part) {
    return (has(part.channels, "R") && has(part.channels, "G") && has(part.channels, "B")) ||
           (has(part.channels, "r") && has(part.channels, "g") && has(part.channels, "b")) || has(part.channels, "Y");
}

/// "rgba.left" of the view "left" is "rgba".
std::string without_view(const std::string& name, const std::string& view) {
    if (view.empty() || name.size() <= view.size() + 1) return name;
    const std::size_t at = name.size() - view.size() - 1;
    if (name.compare(at + 1, view.size(), view) == 0 && (name[at] == '.' || name[at] == '_')) return name.substr(0, at);
    if (name.compare(0, view.size(), view) == 0 && (name[view.size()] == '.' || name[view.size()] == '_'))
        return name.substr(view.size() + 1);
    return name;
}

/// Leaves out parts of another view than the first. Returns the names of those views.
std::set<std::string> choose_view(std::vector<ExrPart>& parts) {
    std::string first;
    std::set<std::string> others;
    for (ExrPart& part : parts) {
        if (part.view.empty()) continue;
        if (first.empty()) first = part.view;
        if (part.view == first)
            part.name = without_view(part.name, part.view);
        else
            others.insert(part.view), part.channels.clear();
    }
    return others;
}

/// The channel's name without its view. In a file with a list of views, the view is the last name but one: "right.R", "diffuse.right.R"; a
/// name without a view belongs to the first view. Empty for a channel of another view, which is noted in `others`.
std::string name_in_view(const std::string& channel, const std::vector<std::string>& views, std::set<std::string>& others) {
    const std::size_t dot = channel.rfind('.');
    if (views.empty() || dot == channel.npos) return channel;
    const std::size_t before = channel.rfind('.', dot - 1), start = before == channel.npos || dot == 0 ? 0 : before + 1;
    const std::string view = channel.substr(start, dot - start);
    if (!has(views, view)) return channel;
    if (view == views.front()) return channel.substr(0, start) + channel.substr(dot + 1);
    others.insert(view);
    return "";
}

/// The number of the part with the beauty; the number of parts where none has it.
std::size_t beauty_part(const std::vector<ExrPart>& parts) {
    const auto with = [&](auto accept) {
        return static_cast<std::size_t>(
            std::find_if(parts.begin(), parts.end(), [&](const ExrPart& p) { return has_colour(p) && accept(p); }) - parts.begin());
    };
    const std::size_t named = with([](const ExrPart& p) { return known_pass(p.name) == "beauty"; });
    return named < parts.size() ? named : with([](const ExrPart& p) { return known_pass(p.name).empty(); });
}

} // namespace

ExrNames frame_names(const std::vector<ExrPart>& all, const std::vector<std::string>& multi_view) {
    ExrNames names;
    std::vector<ExrPart> parts = all;
    std::vector<std::string> deep;
    for (ExrPart& part : parts)
        if (part.deep) deep.push_back(fmt::format("\"{}\"", part.name)), part.channels.clear();
    std::set<std::string> views = choose_view(parts);
    const std::size_t beauty = parts.size() == 1 ? 0 : beauty_part(parts);
    std::set<std::string> seen, doubled;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        names.parts.emplace_back();
        for (const auto& channel : all[p].channels) {
            std::string name;
            if (!parts[p].channels.empty()) name = name_in_view(channel, multi_view, views);
            if (!name.empty() && parts.size() > 1) {
                const std::string layer = parts[p].name + ".";
                const bool own = name.compare(0, layer.size(), layer) == 0;
                if (p == beauty && own)
                    name = name.substr(layer.size());
                else if (p != beauty && name.find('.') == name.npos)
                    name = layer + name;
            }
            if (!name.empty() && !seen.insert(name).second) doubled.insert(name), name.clear();
            names.parts.back().push_back(name);
        }
    }
    if (!deep.empty()) names.notes.push_back(fmt::format("the deep parts {} are left out", fmt::join(deep, " ")));
    if (!views.empty()) names.notes.push_back(fmt::format("holds several views: the first is taken; left out: {}", fmt::join(views, " ")));
    if (!doubled.empty()) names.notes.push_back(fmt::format("several parts have {}: the first one's is taken", fmt::join(doubled, " ")));
    if (parts.size() > 1 && beauty < parts.size() && known_pass(parts[beauty].name) != "beauty")
        names.notes.push_back(fmt::format("part \"{}\" is taken as the beauty", parts[beauty].name));
    return names;
}

} // namespace clvr
