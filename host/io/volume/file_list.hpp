// Headers that name several files for the voxels: a list of names, or a pattern with numbers.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clvr {

/// "name%03d.raw 1 8 1" and the like.
struct NumberedFiles {
    std::string pattern;
    std::vector<std::int64_t> numbers; ///< what stands behind the name: min, max, step, ...
};
/// Splits a value that ends in at least `least` whole numbers after a name with one "%d" (with flags and width: "%03d"). Nothing for any
/// other text: a % in a name is no pattern by itself.
std::optional<NumberedFiles> numbered_files(std::string_view value, std::size_t least);

/// The names of the pattern for min, min + step, ... up to max. Throws Error{input} (naming `header`) for a step of 0 or above a million
/// names.
std::vector<std::string> names_of(const std::string& pattern, std::int64_t min, std::int64_t max, std::int64_t step,
                                  const std::string& header);

/// Throws Error{input} unless `files` files, each of the first `subdim` axes, make up all `sizes`.
void check_file_count(std::size_t files, const std::vector<std::int64_t>& sizes, std::int64_t subdim, const std::string& header);

} // namespace clvr
