#include "host/io/volume/metaimage_header.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/text_lines.hpp"

namespace clvr {

std::string MetaHeader::tag(const std::string& name, const std::string& fallback) const {
    const auto t = tags.find(name);
    return t == tags.end() ? fallback : t->second;
}

const std::string& MetaHeader::required(const char* name, const std::string& path) const {
    const auto t = tags.find(name);
    if (t == tags.end()) bad_file(path, "the MetaImage header has no {}", name);
    return t->second;
}

bool MetaHeader::is_true(const char* name, bool fallback) const {
    const std::string value = lower_case(tag(name, fallback ? "true" : "false"));
    return !value.empty() && (value[0] == 't' || value[0] == '1' || value[0] == 'y');
}

MetaHeader parse_metaimage_header(const std::string& path) {
    FileBytes file(path, ByteStream::Coding::plain);
    TextLines lines(file, path);
    MetaHeader h;
    while (const std::optional<std::string> whole = lines.line()) {
        const std::string_view line = trimmed(*whole);
        if (line.empty()) continue;
        const auto equals = line.find('=') != std::string_view::npos ? line.find('=') : line.find(':');
        const std::string tag(trimmed(line.substr(0, equals)));
        if (equals == std::string_view::npos || tag.empty())
            bad_file(path, "\"{:.40}\" is no line of a MetaImage header (Tag = value)", line);
        if (!h.tags.emplace(tag, trimmed(line.substr(equals + 1))).second)
            bad_file(path, "the tag {:.100} stands twice in the header", tag);
        if (tag != "ElementDataFile") continue;
        h.bytes = lines.position();
        if (h.tags.at(tag).rfind("LIST", 0) == 0)
            while (const std::optional<std::string> name = lines.line())
                if (!trimmed(*name).empty()) h.listed.emplace_back(trimmed(*name));
        return h;
    }
    bad_file(path, "the MetaImage header has no ElementDataFile: the file is truncated or damaged");
}

} // namespace clvr
