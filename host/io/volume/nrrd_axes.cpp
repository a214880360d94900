#include "host/io/volume/nrrd_axes.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/reading_options.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace clvr {

namespace {

enum class NrrdRole { space, time, list, channel, foreign };

/// By the kind alone; `directed`: 1 the axis has a vector in space, -1 the header says it has none, 0 the header gives no directions.
NrrdRole role_of(const std::string& kind, int directed, const std::string& path) {
    static const std::set<std::string> channels{"vector",   "covariant-vector", "normal",     "point",  "2-vector", "3-vector",
                                                "4-vector", "3-normal",         "3-gradient", "scalar", "stub"};
    static const std::set<std::string> foreign{"complex", "quaternion"};
    if (kind == "time") return NrrdRole::time;
    if (kind == "list") return NrrdRole::list;
    if (channels.count(kind)) return NrrdRole::channel;
    if (foreign.count(kind) || kind.find("color") != std::string::npos || kind.find("matrix") != std::string::npos)
        return NrrdRole::foreign;
    if (kind != "domain" && kind != "space" && !kind.empty() && kind != "???" && kind != "none")
        bad_file(path, "the NRRD kind \"{:.40}\" is not known: expected domain, space, time, list, vector, ...", kind);
    if (directed < 0) return kind == "domain" || kind == "space" ? NrrdRole::time : NrrdRole::list;
    return NrrdRole::space;
}

/// Whether a direction runs along a fourth axis of the space alone: that of time.
bool runs_in_time(const std::string& direction) {
    const auto v = parse_numbers(direction);
    return v && v->size() == 4 && (*v)[0] == 0 && (*v)[1] == 0 && (*v)[2] == 0 && (*v)[3] != 0;
}

} // namespace

NrrdAxes nrrd_axes(const NrrdHeader& h, const VolumeReadOptions& options, Voxels& v) {
    const std::string& path = v.source;
    const auto required = [&](const char* field) {
        if (!h.fields.count(field)) bad_file(path, "the NRRD header has no \"{}\"", field);
        return h.fields.at(field);
    };
    const auto dimension = parse_integers(required("dimension"), 1, 1, "\"dimension\"", path).front();
    if (dimension > 16) bad_file(path, "the volume has {} dimensions: a NRRD file has at most 16", dimension);
    const auto count = static_cast<std::size_t>(dimension);
    NrrdAxes axes;
    axes.sizes = parse_integers(required("sizes"), count, 1, "\"sizes\"", path);
    auto kinds = nrrd_words_per_axis(h, "kinds", count, path);
    kinds.resize(count);
    const auto directions = nrrd_words_per_axis(h, "spacedirections", count, path);

    std::vector<NrrdRole> roles(count, NrrdRole::space);
    std::size_t spatial = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const bool none = !directions.empty() && lower_case(directions[i]) == "none";
        roles[i] = role_of(lower_case(kinds[i]), directions.empty() ? 0 : none ? -1 : 1, path);
        if (roles[i] == NrrdRole::space && !directions.empty() && runs_in_time(directions[i])) roles[i] = NrrdRole::time;
        if (roles[i] == NrrdRole::space && ++spatial > 3) roles[i] = NrrdRole::time;
    }
    const auto several = [&](NrrdRole role) {
        return std::count_if(roles.begin(), roles.end(), [&](const NrrdRole& r) { return r == role && axes.sizes[&r - roles.data()] > 1; });
    };
    // A list is of times, unless there are times already or the user asks for a channel.
    const bool list_is_channel =
        several(NrrdRole::time) > 0 || (options.channel && several(NrrdRole::channel) == 0 && several(NrrdRole::foreign) == 0);
    std::replace(roles.begin(), roles.end(), NrrdRole::list, list_is_channel ? NrrdRole::channel : NrrdRole::time);
    if (several(NrrdRole::time) > 1 || several(NrrdRole::channel) + several(NrrdRole::foreign) > 1)
        bad_file(path, "the volume has {} axes beside space with more than one entry: clvr reads at most one of times and one of channels",
                 several(NrrdRole::time) + several(NrrdRole::channel) + several(NrrdRole::foreign));

    std::int64_t faster = 1, frames = 1, channels = 1;
    for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t n = axes.sizes[i];
        if (roles[i] == NrrdRole::space) {
            axes.spatial.push_back(i);
            faster = std::min(faster, std::int64_t{1} << 31) * std::min(n, std::int64_t{1} << 31); // a hostile size is refused later
            continue;
        }
        if (n == 1) continue;
        OtherAxis other{n, 0, faster};
        if (roles[i] == NrrdRole::time) {
            frames = n;
            check_frame(options.frame, n, path);
            other.index = options.frame;
            v.frames = say_frame(options.frame, n, kinds[i].empty() ? "the axis beside space" : kinds[i].c_str(), v.decisions);
        } else {
            if (roles[i] == NrrdRole::foreign && !options.channel)
                bad_file(path, "each voxel has {} values (NRRD kind \"{}\"): clvr renders scalar volumes, --channel N takes one of them", n,
                         lower_case(kinds[i]));
            channels = n;
            other.index = chosen_channel(options, n, path, v.notes);
        }
        axes.others.push_back(other);
    }
    if (frames == 1) check_frame(options.frame, 1, path);
    if (channels == 1) chosen_channel(options, 1, path, v.notes);
    if (axes.spatial.empty()) bad_file(path, "none of its {} axes is of space", count);
    return axes;
}

} // namespace clvr
