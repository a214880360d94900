#include "runtime/opencl/program_cache.hpp"

#include "runtime/system/folders.hpp"
#include "runtime/system/hashes.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clvr {
namespace {

constexpr std::string_view program_format = "clvr program 1";

std::string header_of(const std::string& key, std::string_view binary) {
    return fmt::format("{}\n{}\n{}\n{}\n", program_format, key, binary.size(), sha256_hex(binary));
}

std::filesystem::path entry_path(const std::filesystem::path& folder, const std::string& key) { return folder / "programs" / key; }

} // namespace

std::string program_key(const DeviceFacts& facts, std::string_view source, std::string_view options) {
    return sha256_hex(
        {program_format, source, options, facts.name, facts.version, facts.driver_version, facts.platform, facts.platform_version});
}

std::string encode_entry(const std::string& key, std::string_view binary) { return header_of(key, binary).append(binary); }

std::optional<std::string> decode_entry(const std::string& key, std::string_view entry) {
    std::size_t start = 0;
    for (int line = 0; line < 4; ++line) {
        const std::size_t end = entry.find('\n', start);
        if (end == std::string_view::npos) return std::nullopt;
        start = end + 1;
    }
    const std::string_view binary = entry.substr(start);
    if (binary.empty() || entry.substr(0, start) != header_of(key, binary)) return std::nullopt;
    return std::string(binary);
}

std::optional<std::string> load_program(const std::string& key) {
    const auto folder = cache_folder();
    if (!folder) return std::nullopt;
    const auto entry = load_file(entry_path(*folder, key));
    if (!entry) return std::nullopt;
    auto binary = decode_entry(key, *entry);
    if (!binary) spdlog::debug("the cached program {} is broken and will be built anew", entry_path(*folder, key).string());
    return binary;
}

void store_program(const std::string& key, std::string_view binary) {
    const auto folder = cache_folder();
    if (folder && !replace_file(entry_path(*folder, key), encode_entry(key, binary)))
        spdlog::debug("the program {} could not be stored", entry_path(*folder, key).string());
}

} // namespace clvr
