// NRRD, attached and detached: the fields of the header that decide what the file must hold (teem.sourceforge.net/nrrd/format.html).
#include "host/io/volume/itk.hpp"
#include "host/io/volume/readers.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace clvr {

namespace {

constexpr std::size_t greatest_header = std::size_t{1} << 20;

struct NrrdHeader {
    std::map<std::string, std::string> fields; ///< lower case, without blanks ("datafile", "spacedirections")
    bool segmentation = false;                 ///< 3D Slicer's mark of a label map
    std::uint64_t bytes = 0;                   ///< up to the empty line and with it
};

NrrdHeader parse_header(const std::string& path) {
    const std::string text = read_head(path, greatest_header);
    NrrdHeader h;
    std::size_t at = text.find('\n'); // the first line is the magic
    if (at == std::string::npos) bad_file(path, "the NRRD header ends in its first line: the file is truncated");
    for (++at;;) {
        const auto end = text.find('\n', at);
        const std::string_view line = trimmed(std::string_view(text).substr(at, end == std::string::npos ? std::string::npos : end - at));
        if (line.size() > 4096) bad_file(path, "a line of the NRRD header has {} characters: the file is damaged", line.size());
        at = end == std::string::npos ? text.size() : end + 1;
        if (line.empty()) break;
        if (end == std::string::npos && h.fields.count("datafile") == 0)
            bad_file(path, "the NRRD header has no end (an empty line): the file is truncated");
        if (line.front() != '#') {
            const auto colon = line.find(':');
            if (colon == std::string_view::npos) bad_file(path, "\"{:.40}\" is no line of a NRRD header (field: value)", line);
            std::string name = lower_case(line.substr(0, colon));
            if (colon + 1 < line.size() && line[colon + 1] == '=') {
                h.segmentation = h.segmentation || name.rfind("segment0_", 0) == 0;
            } else {
                name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
                const std::string_view value = trimmed(line.substr(colon + 1));
                if (name == "datafile" && (lower_case(value).rfind("list", 0) == 0 || value.find('%') != std::string_view::npos))
                    bad_file(path, "voxels in many files (data file: {:.40}) are not read: save the volume as one .nrrd", value);
                if (!h.fields.emplace(name, value).second) bad_file(path, "the NRRD field \"{}\" stands twice", name);
            }
        }
        if (at >= text.size()) break;
    }
    h.bytes = at;
    return h;
}

const std::string& required(const NrrdHeader& h, const char* field, const std::string& path) {
    const auto f = h.fields.find(field);
    if (f == h.fields.end()) bad_file(path, "the NRRD header has no \"{}\"", field);
    return f->second;
}

std::string optional_field(const NrrdHeader& h, const char* field, std::string fallback = {}) {
    const auto f = h.fields.find(field);
    return f == h.fields.end() ? fallback : f->second;
}

/// The words of a field; "(a, b, c)" is one.
std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    bool open = false, fresh = true;
    for (const char c : text) {
        open = c == '(' || (open && c != ')');
        if (!open && (c == ' ' || c == '\t')) {
            fresh = true;
            continue;
        }
        if (fresh) words.emplace_back();
        fresh = false;
        words.back() += c;
    }
    return words;
}

/// Voxel sizes and directions as they stand in the file: ITK would take 1 mm for what is not a number. Returns whether any is given.
bool check_axes(const NrrdHeader& h, const std::vector<bool>& spatial, const std::string& path) {
    const auto each = [&](const char* field, const auto& check) {
        const auto words = words_of(optional_field(h, field));
        if (words.empty()) return false;
        if (words.size() != spatial.size()) bad_file(path, "\"{}\" has {} entries for {} axes", field, words.size(), spatial.size());
        for (std::size_t i = 0; i < words.size(); ++i)
            if (spatial[i]) check(words[i]);
        return true;
    };
    const bool spacings = each("spacings", [&](const std::string& w) { check_spacing(w, 1, "\"spacings\"", path); });
    const bool directions = each("spacedirections", [&](const std::string& w) {
        const auto v = parse_numbers(w);
        double length = 0;
        if (v && v->size() >= 2 && v->size() <= 4)
            for (const double x : *v) length += x * x;
        if (!(length > 0) || !std::isfinite(length))
            bad_file(path, "\"space directions\" holds {:.60}: expected vectors that are finite and not 0", w);
    });
    return spacings || directions;
}

/// Millimetres of the file's unit: "space units: "mm" ..." or, without a space, "units: "mm" ...".
double unit_of(const NrrdHeader& h) {
    static const std::map<std::string, double> units{{"um", 1e-3},      {"\xc2\xb5m", 1e-3},  {"micron", 1e-3},
                                                     {"microns", 1e-3}, {"micrometer", 1e-3}, {"nm", 1e-6},
                                                     {"cm", 10},        {"m", 1000},          {"meter", 1000}};
    const std::string text = optional_field(h, "spaceunits", optional_field(h, "units"));
    const auto first = text.find('"'), last = text.find('"', first == std::string::npos ? first : first + 1);
    if (last == std::string::npos) return 1;
    const auto unit = units.find(text.substr(first + 1, last - first - 1));
    return unit == units.end() ? 1 : unit->second;
}

void place_payload(Container& c, const NrrdHeader& h, const std::string& path) {
    const std::string encoding = lower_case(required(h, "encoding", path)), data = optional_field(h, "datafile");
    if (encoding == "gzip" || encoding == "gz")
        c.coding = Container::Coding::deflated;
    else if (encoding == "txt" || encoding == "text" || encoding == "ascii")
        c.coding = Container::Coding::text;
    else if (encoding != "raw")
        bad_file(path, "NRRD encoding \"{}\" is not read: save it as raw or gzip", encoding);
    c.data_path = data.empty() ? path : beside(path, data);
    c.offset = data.empty() ? h.bytes : 0;
    const auto skip = parse_integers(optional_field(h, "byteskip", "0"), 1, -1, "\"byte skip\"", path).front();
    if (parse_integers(optional_field(h, "lineskip", "0"), 1, 0, "\"line skip\"", path).front() != 0 ||
        (skip != 0 && c.coding != Container::Coding::plain))
        bad_file(path, "\"line skip\", or \"byte skip\" in encoded data, is not read: save the volume as one .nrrd");
    const std::uint64_t size = std::filesystem::file_size(c.data_path), bytes = check_dims(c.dims, c.frames, c.type, path).bytes;
    if (skip >= 0)
        c.offset += static_cast<std::uint64_t>(skip);
    else // the voxels are the last bytes of the file
        c.offset = size >= bytes ? size - bytes : size;
    if (c.coding == Container::Coding::plain && size > c.offset && size - c.offset > bytes)
        c.notes.push_back(fmt::format("{} bytes after the voxels were ignored: is the header right?", size - c.offset - bytes));
}

} // namespace

Voxels read_nrrd(const std::string& path, const VolumeReadOptions& options) {
    const NrrdHeader h = parse_header(path);
    if (h.segmentation) bad_file(path, "the file is a segmentation of 3D Slicer (a label map): clvr renders measured values, not labels");
    const auto dimension = parse_integers(required(h, "dimension", path), 1, 1, "\"dimension\"", path).front();
    if (dimension > 4) bad_file(path, "the volume has {} dimensions: expected at most 3 and time", dimension);
    const auto sizes = parse_integers(required(h, "sizes", path), static_cast<std::size_t>(dimension), 1, "\"sizes\"", path);
    const auto type = parse_sample_type(lower_case(required(h, "type", path)));
    if (!type) bad_file(path, "NRRD type \"{}\" is not read: expected an integer, float or double", h.fields.at("type"));

    Container c;
    c.type = *type;
    std::vector<std::string> kinds = words_of(lower_case(optional_field(h, "kinds")));
    kinds.resize(sizes.size());
    std::vector<bool> spatial(sizes.size(), true);
    std::vector<std::int64_t> space;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const std::string& kind = kinds[i];
        if (kind.empty() || kind == "domain" || kind == "space" || kind == "time" || kind == "???" || kind == "none") {
            space.push_back(sizes[i]);
            spatial[i] = space.size() <= 3 && kind != "time";
        } else if (kind == "list") {
            c.frames = sizes[i];
            c.frames_interleaved = true;
            spatial[i] = false;
        } else {
            bad_file(path, "each voxel has {} values (NRRD kind \"{}\"): clvr renders scalar volumes, extract one channel", sizes[i], kind);
        }
    }
    if (space.size() > 3) c.frames = space[3];
    for (std::size_t i = 0; i < std::min<std::size_t>(space.size(), 3); ++i) c.dims[i] = space[i];
    if (!check_axes(h, spatial, path)) c.notes.push_back("the file gives no voxel spacing: 1 mm is assumed");
    c.text_may_be_nan = true;
    c.unit_mm = unit_of(h);
    place_payload(c, h, path);
    return decode_with_itk(ItkReader::nrrd, c, path, "NRRD", options.frame);
}

} // namespace clvr
