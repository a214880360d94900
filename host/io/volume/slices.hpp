// The files of a folder that are the slices of one volume, in order.
#pragma once
#include <string>
#include <vector>

namespace clvr {

struct SliceStack {
    std::vector<std::string> paths; ///< in the order of the slices
    std::vector<std::string> notes, decisions;
};
/// Orders files of `folder` (and the folders inside it) by the one number in their names that varies: whole, decimal, signed, with or
/// without leading zeros. Throws Error{input} where that is not sure or slices would be lost: files with other names than the rest, several
/// numbers that vary, one number twice, a number missing or uneven steps (`allow_gaps`: taken as neighbours, noted).
SliceStack slice_stack(const std::string& folder, const std::vector<std::string>& files, bool allow_gaps);

} // namespace clvr
