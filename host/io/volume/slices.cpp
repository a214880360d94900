#include "host/io/volume/slices.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <tuple>

namespace clvr {

namespace {

/// "slice" and 12 of slice_0012.tif: files of one stack share the first, and are ordered by the second.
struct NumberedName {
    std::string base;
    unsigned long long number = 0;
    std::string path;
};
NumberedName split_number(const std::filesystem::path& path) {
    const std::string stem = path.stem().string();
    const auto last = stem.find_last_of("0123456789");
    if (last == std::string::npos) return {stem, 0, path.string()};
    const auto before = stem.find_last_not_of("0123456789", last);
    const auto first = before == std::string::npos ? 0 : before + 1;
    const std::string digits = stem.substr(first, std::min<std::size_t>(last + 1 - first, 18));
    return {stem.substr(0, first) + "#" + stem.substr(last + 1), std::stoull(digits), path.string()};
}

} // namespace

SliceStack slice_stack(const std::string&, const std::vector<std::string>& files) {
    std::map<std::string, std::vector<NumberedName>> stacks;
    for (const auto& f : files) {
        NumberedName n = split_number(f);
        stacks[n.base].push_back(std::move(n));
    }
    auto& stack = std::max_element(stacks.begin(), stacks.end(), [](const auto& a, const auto& b) {
                      return a.second.size() < b.second.size();
                  })->second;
    std::sort(stack.begin(), stack.end(),
              [](const auto& a, const auto& b) { return std::tie(a.number, a.path) < std::tie(b.number, b.path); });
    SliceStack s;
    for (const auto& n : stack) s.paths.push_back(n.path);
    if (stack.size() < files.size())
        s.notes.push_back(fmt::format("{} of {} files in the folder have other names than the {} of this stack and were left out",
                                      files.size() - stack.size(), files.size(), stack.size()));
    if (const auto span = stack.back().number - stack.front().number + 1; span > stack.size())
        s.notes.push_back(fmt::format("the slices are numbered {} to {} but there are only {}: taken as neighbours", stack.front().number,
                                      stack.back().number, stack.size()));
    return s;
}

} // namespace clvr
