#include "host/io/volume/nrrd_header.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/text_lines.hpp"

#include <algorithm>
#include <set>

namespace clvr {

namespace {

/// A field's name as clvr keeps it: lower case, no blanks, one spelling.
std::string field_name(std::string_view name) {
    std::string settled = lower_case(name);
    settled.erase(std::remove(settled.begin(), settled.end(), ' '), settled.end());
    return settled == "centers" ? "centerings" : settled;
}

bool is_used(const std::string& field) {
    static const std::set<std::string> used{"dimension", "type",           "sizes",           "endian",      "encoding",
                                            "datafile",  "lineskip",       "byteskip",        "space",       "kinds",
                                            "spacings",  "spacedimension", "spacedirections", "spaceorigin", "spaceunits",
                                            "units",     "axismins",       "axismaxs",        "centerings"};
    return used.count(field) > 0;
}

} // namespace

std::string NrrdHeader::field(const std::string& name, const std::string& fallback) const {
    const auto f = fields.find(name);
    return f == fields.end() ? fallback : f->second;
}

NrrdHeader parse_nrrd_header(const std::string& path) {
    FileBytes file(path, ByteStream::Coding::plain);
    TextLines lines(file, path);
    NrrdHeader h;
    if (lines.line().value_or("").rfind("NRRD", 0) != 0) bad_file(path, "its first line is not that of a NRRD file (NRRD0004)");
    bool listing = false;
    while (true) {
        const std::optional<std::string> whole = lines.line();
        if (!whole && h.fields.count("datafile") == 0) bad_file(path, "the NRRD header has no end (an empty line): the file is truncated");
        if (!whole) break;
        const std::string_view line = trimmed(*whole);
        if (listing) {
            if (!line.empty()) h.listed.emplace_back(line);
            continue;
        }
        if (line.empty()) break;
        if (line.front() == '#') continue;
        const auto colon = line.find(':');
        if (colon == std::string_view::npos) bad_file(path, "\"{:.40}\" is no line of a NRRD header (field: value)", line);
        if (colon + 1 < line.size() && line[colon + 1] == '=') {
            h.segmentation = h.segmentation || lower_case(line.substr(0, colon)).rfind("segment0_", 0) == 0;
            continue;
        }
        const std::string name = field_name(line.substr(0, colon));
        const std::string_view value = trimmed(line.substr(colon + 1));
        if (!h.fields.emplace(name, value).second && is_used(name)) bad_file(path, "the NRRD field \"{}\" stands twice", name);
        listing = name == "datafile" && lower_case(value.substr(0, 4)) == "list" && (value.size() == 4 || value[4] == ' ');
    }
    h.bytes = lines.position();
    return h;
}

std::vector<std::string> nrrd_words(const std::string& text) {
    std::vector<std::string> words;
    bool quoted = false, open = false, fresh = true;
    for (const char c : text) {
        if (c == '"') {
            quoted = !quoted;
            if (quoted) words.emplace_back();
            fresh = !quoted;
            continue;
        }
        open = !quoted && (c == '(' || (open && c != ')'));
        if (!open && !quoted && (c == ' ' || c == '\t')) {
            fresh = true;
            continue;
        }
        if (fresh) words.emplace_back();
        fresh = false;
        words.back() += c;
    }
    return words;
}

std::vector<std::string> nrrd_words_per_axis(const NrrdHeader& h, const char* field, std::size_t axes, const std::string& path) {
    std::vector<std::string> words = nrrd_words(h.field(field));
    if (!words.empty() && words.size() != axes) bad_file(path, "\"{}\" has {} entries for {} axes", field, words.size(), axes);
    return words;
}

} // namespace clvr
