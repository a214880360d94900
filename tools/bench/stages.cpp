#include "runtime/error.hpp"
#include "runtime/sha256.hpp"
#include "tools/bench/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace clvr::bench {
namespace {

/// By stage: at the standard size and at the tiny one. Equal on every device that is right. `clvr-bench --hashes` prints what it finds.
const std::map<std::string, std::pair<std::string, std::string>>& golden() {
    static const std::map<std::string, std::pair<std::string, std::string>> hashes{
        // GOLDEN
    };
    return hashes;
}

} // namespace

const char* size_name(Size size) { return size == Size::standard ? "standard" : "tiny"; }

const std::vector<Stage>& stages() {
    static const std::vector<Stage> all = [] {
        std::vector<Stage> list;
        for (const auto& part : {probe_stages(), transfer_stages(), render_stages(), network_stages()})
            list.insert(list.end(), part.begin(), part.end());
        return list;
    }();
    return all;
}

const Stage& stage_named(const std::string& name) {
    const auto found = std::find_if(stages().begin(), stages().end(), [&](const Stage& s) { return s.name == name; });
    if (found == stages().end()) throw Error(ErrorKind::usage, fmt::format("\"{}\" is no stage of clvr-bench", name));
    return *found;
}

std::string golden_hash(const std::string& stage, Size size) {
    const auto found = golden().find(stage);
    if (found == golden().end()) return {};
    return size == Size::standard ? found->second.first : found->second.second;
}

std::string hash_of(const std::vector<float>& values) {
    return sha256_hex(std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)));
}

float noise(std::uint32_t i) {
    i = (i ^ (i >> 16)) * 0x7feb352du;
    i = (i ^ (i >> 15)) * 0x846ca68bu;
    return static_cast<float>((i ^ (i >> 16)) >> 8) / (1 << 24);
}

std::vector<float> noise_values(std::size_t count) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = noise(static_cast<std::uint32_t>(i + 1));
    return values;
}

} // namespace clvr::bench
