#include "host/pairs/folder.hpp"
#include "host/io/file_roles.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_text.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {
namespace fs = std::filesystem;

std::string noisy_name(int view, int frame) { return fmt::format("view_{:04}_noisy_{}.exr", view, frame); }
bool is_frame_name(const std::string& name) { return name.rfind("view_", 0) == 0 && std::filesystem::path(name).extension() == ".exr"; }
std::string reference_name(int view) { return fmt::format("view_{:04}_reference.exr", view); }

PairsFolder read_pairs(const std::string& folder) {
    const std::string path = (fs::path(folder) / "pairs.json").string();
    std::error_code failed;
    if (!fs::is_regular_file(path, failed))
        throw Error(ErrorKind::input, "has no pairs.json; make a folder of training pairs with `clvr pairs VOLUME -o DIR`", folder);
    PairsFolder pairs;
    int views = 0, frames = 0, reference_spp = 0;
    try {
        const nlohmann::json plan = nlohmann::json::parse(read_text(path));
        will_read(path);
        if (plan.at(format_key) != pairs_format)
            throw Error(ErrorKind::input, fmt::format("is of another format; expected {}", pairs_format), path);
        pairs.split = plan.at("split").get<std::string>();
        views = static_cast<int>(plan.at("views").size());
        frames = plan.at("noisy_frames").get<int>();
        reference_spp = plan.at("reference_spp").get<int>();
        const auto spp = plan.value("spp", std::vector<int>()); // in turn
        for (int k = 0; k < frames && !spp.empty(); ++k) pairs.spp.push_back(spp[static_cast<std::size_t>(k) % spp.size()]);
    } catch (const nlohmann::json::exception&) {
        throw Error(ErrorKind::input, "is damaged, or not what `clvr pairs` writes", path);
    }
    if (views < 1 || frames < 1) throw Error(ErrorKind::input, "names no views", path);
    const auto there = [&](const std::string& name) {
        const std::string file = (fs::path(folder) / name).string();
        if (!fs::is_regular_file(file, failed))
            throw Error(ErrorKind::input, fmt::format("lacks {}; finish it with the `clvr pairs` command that began it", name), folder);
        return file;
    };
    for (int v = 0; v < views; ++v) {
        PairView view;
        for (int k = 0; k < frames; ++k) view.noisy.push_back(there(noisy_name(v, k)));
        if (reference_spp > 0) view.reference = there(reference_name(v));
        pairs.views.push_back(std::move(view));
    }
    return pairs;
}

} // namespace clvr
