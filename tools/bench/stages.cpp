#include "runtime/error.hpp"
#include "runtime/system/hashes.hpp"
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
        {"launch latency", {"counted", "counted"}},
        {"build, cold",
         {"4455ef24e71388b04a688fd87dcb9094d03703b9d4e2aae9ac64e3eade1d5f86",
          "4455ef24e71388b04a688fd87dcb9094d03703b9d4e2aae9ac64e3eade1d5f86"}},
        {"build, cached",
         {"4455ef24e71388b04a688fd87dcb9094d03703b9d4e2aae9ac64e3eade1d5f86",
          "4455ef24e71388b04a688fd87dcb9094d03703b9d4e2aae9ac64e3eade1d5f86"}},
        {"copy",
         {"fc3523aa567fb227228c0fd44b7fee993ce114d37ecc4d3b20d5d0386a17cb3d",
          "6a9eefbb365600401478eb92fba7776107705dcab328d6aea555332e098ebebd"}},
        {"triad",
         {"8e8dd4b53fb3b24d2f08153a51c5a7c91708e7a033245d56e9bccf876f4ab439",
          "7c1b87fe6b035325bc09c7ea745eb32f02b4106924838f0ab56793634b05912a"}},
        {"FMA rate",
         {"c218afdd5cca572485c495e264098431b2d3c92c29556ed63ab10833c79abbac",
          "5110ccecc22739c90c0cbcfdb3dd0ea70146e4fb074587b4028e6ef1cde2ab43"}},
        {"samples, buffer",
         {"4195459ead93e51b52a068781fa3425aa5793cda21e8045720842d0d267b321d",
          "72de77f3b19767289bbb07990d0a7f4d86c3b6f9f3af5118ede54c669951a6b9"}},
        {"samples, image", {"as from a buffer", "as from a buffer"}},
        {"write, pageable",
         {"ce018bdde2821b3017f6f7c06f368c5c47e7f51049110f91ba5ab532f7682529",
          "1b821c004f3e4f070061c4d566627183a0e5da06cf47c90c17cfe140501ad9b3"}},
        {"read, pageable",
         {"ce018bdde2821b3017f6f7c06f368c5c47e7f51049110f91ba5ab532f7682529",
          "1b821c004f3e4f070061c4d566627183a0e5da06cf47c90c17cfe140501ad9b3"}},
        {"write, pinned",
         {"ce018bdde2821b3017f6f7c06f368c5c47e7f51049110f91ba5ab532f7682529",
          "1b821c004f3e4f070061c4d566627183a0e5da06cf47c90c17cfe140501ad9b3"}},
        {"read, pinned",
         {"ce018bdde2821b3017f6f7c06f368c5c47e7f51049110f91ba5ab532f7682529",
          "1b821c004f3e4f070061c4d566627183a0e5da06cf47c90c17cfe140501ad9b3"}},
        {"write, mapped",
         {"ce018bdde2821b3017f6f7c06f368c5c47e7f51049110f91ba5ab532f7682529",
          "1b821c004f3e4f070061c4d566627183a0e5da06cf47c90c17cfe140501ad9b3"}},
        {"read, mapped",
         {"ce018bdde2821b3017f6f7c06f368c5c47e7f51049110f91ba5ab532f7682529",
          "1b821c004f3e4f070061c4d566627183a0e5da06cf47c90c17cfe140501ad9b3"}},
        {"path trace",
         {"9dbf41a3520b512c44e965e98e2ad9f0b802b80dcb72f87ed3c0b2b506471fbd",
          "51912de157e9c9464614d87939d8c79cbc8dc51483d99e60ce194ab2435032f7"}},
        {"feature march",
         {"848c0082efc57bcf57b35bde58fe043ba185fd2f0735a551e5f0d301932f5fc4",
          "e7da1890bc9a7ddc30e656fb029b0a3e203d56575845ecc3ed1decf159718536"}},
        {"compute volume",
         {"c8b99cfb62b2251fc49551d1192741c6772bde8477a9ce6d30c6c181a7fd7051",
          "46ca9d660a34b6798693ef3e9f06588df266edd06875136047bdb0b79045f730"}},
        {"GuideNet",
         {"6fd16572f927c53880a4b7ceb032713c064f579457a701e9e728567238c5dc14",
          "9e615e2b077090d7dc0a9f22fde1feb8ff0ffd80f6a03070ad03c5e8ee979250"}},
        {"splat",
         {"7b57e0edca8494ece2f25cdce512757371dce8c215bbf00f04dab92e8c6066c9",
          "2898fee599c0331f20ff8cf926f7c930a1f8be4b05cbf1cd097f9b3de92203b3"}},
        {"slice",
         {"3bb39899a5aece80056cad606435717bfbed79fe5ede129cafc5641887ced9c7",
          "52f6ebe2f5cae6ff92f9221fe318b085ce33a7ee9211c60335829d84d9e9a99d"}},
        {"denoise a frame",
         {"7afcf3724f26accbc1523db435df1abe949f8cdd365a227238384d5cc14a31f9",
          "58361e2a1fba296d94f3ccf3e8723b4a74f1a62ef27a0bc164c155f92d0d612c"}},
        {"training step",
         {"d8751b3a353b091b3cbc24d473b24ce448a91151aa9fd128e38d72b30cd1612b",
          "e1c289105ffb32bb20ec56e3bb15978404c9876f1c12628ccb9966bea25f1461"}},
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
