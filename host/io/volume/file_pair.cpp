#include "host/io/volume/file_pair.hpp"
#include "host/io/volume/format.hpp"
#include "host/io/volume/header_text.hpp"

#include <algorithm>
#include <filesystem>

namespace clvr {

std::string file_beside(const std::string& path, const std::vector<std::string>& from, const std::vector<std::string>& to) {
    namespace fs = std::filesystem;
    const fs::path p(path), folder = p.has_parent_path() ? p.parent_path() : ".";
    const std::string name = p.filename().string();
    std::string stem;
    for (const std::string& ending : from)
        if (ends_with(lower_case(name), ending)) stem = name.substr(0, name.size() - ending.size());
    if (stem.empty()) return {};
    std::string best;
    std::size_t best_rank = 2 * to.size();
    std::error_code error;
    std::vector<std::string> names;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
        if (std::error_code ignored; i->is_regular_file(ignored)) names.push_back(i->path().filename().string());
    std::sort(names.begin(), names.end());
    for (const std::string& other : names)
        for (std::size_t i = 0; i < to.size(); ++i)
            if (const std::size_t rank = other.compare(0, stem.size(), stem) == 0 ? i : i + to.size();
                rank < best_rank && lower_case(other) == lower_case(stem) + to[i]) {
                best_rank = rank;
                best = (p.parent_path() / other).string();
            }
    return best;
}

} // namespace clvr
