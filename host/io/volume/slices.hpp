// The files of a folder that are the slices of one volume, in order.
#pragma once
#include <string>
#include <vector>

namespace clvr {

struct SliceStack {
    std::vector<std::string> paths; ///< in the order of the slices
    std::vector<std::string> notes;
};
/// Orders files by the number in their names. `folder` is named in errors.
SliceStack slice_stack(const std::string& folder, const std::vector<std::string>& files);

} // namespace clvr
