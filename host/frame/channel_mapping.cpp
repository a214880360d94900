#include "host/frame/channel_mapping.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace clvr {

namespace {

struct Pass {
    const char *name, *components;      // clvr's
    const char* others;                 // other names of the components, in their order; the last stands for what is left
    std::vector<const char*> spellings; // the best first: lower case, without spaces, underscores and the view layer's name
};

const std::array<Pass, 4>& passes() {
    static const std::array<Pass, 4> all{{
        // those made for denoisers (Cycles, Arnold, OIDN) come before colours of the diffuse part alone (Cycles, V-Ray, Redshift)
        {"beauty", "RGBA", "", {"combined", "beauty", "rgba", "rgb", "c", "ci", "rgbcolor", "color", "main", "default"}},
        {"albedo",
         "RGB",
         "XYZ",
         {"albedo", "denoisingalbedo", "denoisealbedo", "visiblediffuse", "diffusealbedo", "diffcol", "diffusecolor", "diffusefilter",
          "vraydiffusefilter", "basecolor"}},
        {"normal", "XYZ", "RGB", {"normal", "denoisingnormal", "denoisenormal", "normals", "n", "nn", "vraynormals"}},
        {"depth", "Z", "VRY", {"depth", "z", "denoisingdepth", "vrayzdepth", "zdepth"}},
    }};
    return all;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// The last part of a layer's name as the spellings are written.
std::string plain(const std::string& layer) {
    std::string name = lower(layer.substr(layer.rfind('.') + 1)); // npos + 1 is 0
    name.erase(std::remove_if(name.begin(), name.end(), [](char c) { return c == ' ' || c == '_' || c == '-'; }), name.end());
    return name;
}

/// Rank of a layer among the spellings of a pass; the number of spellings where it is none of them.
std::size_t rank(const Pass& pass, const std::string& layer) {
    const std::string name = plain(layer);
    return static_cast<std::size_t>(std::find(pass.spellings.begin(), pass.spellings.end(), name) - pass.spellings.begin());
}

std::string layer_of(const std::string& channel) { return channel.substr(0, std::max<std::size_t>(channel.rfind('.') + 1, 1) - 1); }

/// clvr's channel for a component ("R", "x" ...) of a pass; empty: none.
std::string target(const std::string& pass, const std::string& component) {
    if (component.size() != 1) return "";
    const char c = static_cast<char>(std::toupper(static_cast<unsigned char>(component[0])));
    const auto known = std::find_if(passes().begin(), passes().end(), [&](const Pass& p) { return pass == p.name; });
    if (known == passes().end()) return pass + "." + c;
    for (const std::string& theirs : {std::string(known->components), std::string(known->others)})
        if (const std::size_t at = theirs.find(c); at != theirs.npos) {
            const char ours = known->components[std::min(at, std::strlen(known->components) - 1)];
            return pass == "beauty" ? std::string(1, ours) : pass + "." + ours;
        }
    return "";
}

/// The frame's channels of a layer and what they become.
std::vector<std::pair<std::string, std::string>> taken(const Frame& frame, const std::string& layer, const std::string& pass) {
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const auto& [name, values] : frame.channels)
        if (layer_of(name) == layer && name.size() > (layer.empty() ? 0 : layer.size() + 1))
            if (const std::string to = target(pass, name.substr(layer.empty() ? 0 : layer.size() + 1)); !to.empty())
                pairs.emplace_back(name, to);
    return pairs;
}

void take(Frame& frame, const std::vector<std::pair<std::string, std::string>>& pairs) {
    std::map<std::string, std::vector<float>> copies; // before any is written: a layer may be renamed within itself
    for (const auto& [from, to] : pairs) copies[to] = frame.at(from);
    for (auto& [to, values] : copies) frame.channels[to] = std::move(values);
}

/// Whether the pass's channels are there under clvr's names.
bool complete(const Frame& frame, const Pass& pass) {
    const std::string components = std::string(pass.name) == "beauty" ? "RGB" : pass.components;
    return std::all_of(components.begin(), components.end(), [&](char c) { return frame.has(target(pass.name, std::string(1, c))); });
}

/// Whether a depth is a share of something, as clvr's is.
bool is_share(const std::vector<float>& depth) {
    return std::all_of(depth.begin(), depth.end(), [](float z) { return z >= 0 && z <= 1; });
}

} // namespace

std::string known_pass(const std::string& layer) {
    for (const Pass& pass : passes())
        if (rank(pass, layer) < pass.spellings.size()) return pass.name;
    return "";
}

void map_channels(Frame& frame, const std::string& mapping) {
    const std::size_t sign = mapping.find('=');
    if (sign == mapping.npos || sign == 0 || sign + 1 == mapping.size())
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected CLVR'S=THEIRS, for instance albedo=DiffCol", mapping), "--map");
    const std::string to = mapping.substr(0, sign), from = mapping.substr(sign + 1);
    if (frame.has(from) && (to.size() == 1 || to.find('.') != to.npos)) {
        frame.channels[to] = std::vector<float>(frame.at(from));
        return;
    }
    const auto pairs = taken(frame, from, to);
    take(frame, pairs);
    if (!pairs.empty()) return;
    if (frame.has(from)) { // a single channel for a whole pass: grey for a colour, the Z of a depth
        const bool colour = to == "beauty" || to == "albedo";
        if (!colour && to != "depth")
            throw Error(ErrorKind::usage,
                        fmt::format("is \"{}\": {} is one channel; name the channel that it becomes, as {}.X={}", mapping, from, to, from),
                        "--map");
        const std::vector<float> values = frame.at(from);
        for (const char c : std::string(colour ? "RGB" : "Z")) frame.channels[target(to, std::string(1, c))] = values;
        return;
    }
    std::vector<std::string> has;
    for (const auto& [name, values] : frame.channels) has.push_back(name);
    throw Error(ErrorKind::input, fmt::format("has no channel {} or {}.* (--map {}); it has {}", from, from, mapping, fmt::join(has, " ")));
}

std::vector<std::string> map_known_channels(Frame& frame) {
    std::vector<std::string> said;
    std::set<std::string> layers;
    for (const auto& [name, values] : frame.channels) layers.insert(layer_of(name));
    for (const Pass& pass : passes()) {
        if (complete(frame, pass)) continue;
        const bool depth = std::string(pass.name) == "depth", beauty = std::string(pass.name) == "beauty";
        std::vector<std::pair<std::size_t, std::string>> found; // rank, layer
        for (const auto& layer : layers) {
            const std::size_t r = beauty && layer.empty() ? 0 : rank(pass, layer); // r g b without a layer are the beauty
            if (r < pass.spellings.size() && taken(frame, layer, pass.name).size() >= (depth ? 1u : 3u)) found.emplace_back(r, layer);
        }
        std::string name;
        std::vector<std::pair<std::string, std::string>> pairs;
        if (!found.empty()) {
            name = std::min_element(found.begin(), found.end())->second;
            pairs = taken(frame, name, pass.name);
        } else if (depth && frame.has("Z")) {
            pairs = {{"Z", channel::depth}};
        } else {
            continue;
        }
        const std::string theirs = name.empty() ? pairs.front().first : name + ".*";
        if (depth && !is_share(frame.at(pairs.front().first))) {
            said.push_back(fmt::format("{} is not taken as depth.Z: it is no share 0..1", theirs));
            continue;
        }
        take(frame, pairs);
        const auto alike = std::count_if(found.begin(), found.end(), [&](const auto& f) { return plain(f.second) == plain(name); });
        said.push_back(fmt::format("{} is taken as {}{}", beauty && name.empty() ? "r g b" : theirs,
                                   beauty ? "R G B" : std::string(pass.name) + ".*",
                                   alike > 1 ? " (several layers have such a name: the first; --map names another)" : ""));
    }
    return said;
}

} // namespace clvr
