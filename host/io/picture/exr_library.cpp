#include "host/io/picture/exr_library.hpp"
#include "runtime/error.hpp"

#include <ImfThreading.h>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <optional>
#include <thread>

namespace clvr {

namespace {

/// A name that ends with 0; no header of OpenEXR has longer ones than 255.
std::string name_of(std::ifstream& file) {
    std::string name;
    for (int c = file.get(); c > 0 && name.size() < 256; c = file.get()) name += static_cast<char>(c);
    return name;
}

std::uint32_t number_of(std::ifstream& file) {
    unsigned char b[4] = {};
    file.read(reinterpret_cast<char*>(b), 4);
    return b[0] | static_cast<std::uint32_t>(b[1]) << 8 | static_cast<std::uint32_t>(b[2]) << 16 | static_cast<std::uint32_t>(b[3]) << 24;
}

} // namespace

void use_all_cores() {
    [[maybe_unused]] static const bool once = [] {
        Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        return true;
    }();
}

namespace {

/// Sizes of the types whose values OpenEXR reads without looking at the size in the file; nothing for others. [bytes]
std::optional<std::uint64_t> fixed_size(const std::string& type) {
    static const std::map<std::string, std::uint64_t> sizes{{"box2f", 16},
                                                            {"box2i", 16},
                                                            {"chromaticities", 32},
                                                            {"compression", 1},
                                                            {"deepImageState", 1},
                                                            {"double", 8},
                                                            {"envmap", 1},
                                                            {"float", 4},
                                                            {"int", 4},
                                                            {"keycode", 28},
                                                            {"lineOrder", 1},
                                                            {"m33d", 72},
                                                            {"m33f", 36},
                                                            {"m44d", 128},
                                                            {"m44f", 64},
                                                            {"rational", 8},
                                                            {"tiledesc", 9},
                                                            {"timecode", 8},
                                                            {"v2d", 16},
                                                            {"v2f", 8},
                                                            {"v2i", 8},
                                                            {"v3d", 24},
                                                            {"v3f", 12},
                                                            {"v3i", 12}};
    const auto found = sizes.find(type);
    return found == sizes.end() ? std::nullopt : std::optional(found->second);
}

/// The bytes that a value takes: as many as the file says, or as OpenEXR reads whatever the file says. The stream stands at the
/// value.
std::uint64_t true_size(std::ifstream& file, const std::string& type, std::uint64_t said) {
    if (const auto fixed = fixed_size(type)) return *fixed;
    const std::streamoff start = file.tellg();
    if (type == "chlist") {
        while (file && !name_of(file).empty()) file.seekg(16, std::ios::cur);
        return file ? static_cast<std::uint64_t>(file.tellg() - start) : said;
    }
    if (type == "preview") {
        const std::uint64_t width = number_of(file), height = number_of(file);
        return file ? 8 + 4 * width * height : said;
    }
    return said;
}

} // namespace

void check_attribute_sizes(const std::string& path) {
    constexpr std::uint32_t several_parts = 0x1000;
    std::error_code failed;
    const std::uint64_t length = std::filesystem::file_size(path, failed);
    std::ifstream file(path, std::ios::binary);
    number_of(file); // the magic
    const bool parts = (number_of(file) & several_parts) != 0;
    for (bool ended = false; file;) {
        const std::string name = name_of(file);
        if (name.empty()) { // a header ends; several of them end with one more
            if (!parts || ended) return;
            ended = true;
            continue;
        }
        ended = false;
        const std::string type = name_of(file);
        const std::uint64_t size = number_of(file);
        if (!file) return; // OpenEXR says so
        if (!failed && size > length)
            throw Error(ErrorKind::input, fmt::format("is damaged: attribute {} has {} bytes, more than the file", name, size), path);
        const std::streamoff start = file.tellg();
        if (const std::uint64_t found = true_size(file, type, size); found != size)
            throw Error(ErrorKind::input, fmt::format("is damaged: attribute {} has {} bytes, its header says {}", name, found, size),
                        path);
        file.seekg(start + static_cast<std::streamoff>(size));
    }
}

} // namespace clvr
