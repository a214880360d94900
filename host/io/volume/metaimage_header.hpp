// The header of a MetaImage file (itk.org/Wiki/ITK/MetaIO/Documentation).
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace clvr {

struct MetaHeader {
    std::map<std::string, std::string> tags;
    std::vector<std::string> listed; ///< what stands behind "ElementDataFile = LIST"
    std::uint64_t bytes = 0;         ///< ElementDataFile is the last line; what follows are voxels

    bool has(const std::string& tag) const { return tags.count(tag) > 0; }
    /// The value of a tag; `fallback` where there is none.
    std::string tag(const std::string& name, const std::string& fallback = {}) const;
    /// Throws Error{input} where there is none.
    const std::string& required(const char* name, const std::string& path) const;
    /// Whether a tag says True, 1 or Yes.
    bool is_true(const char* name, bool fallback) const;
};

/// Throws Error{input}: no end, a line without "=", a tag twice. Tags that clvr does not know pass.
MetaHeader parse_metaimage_header(const std::string& path);

} // namespace clvr
