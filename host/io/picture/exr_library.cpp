#include "host/io/picture/exr_library.hpp"
#include "runtime/error.hpp"

#include <ImfThreading.h>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
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
        name_of(file); // the type
        const std::uint64_t size = number_of(file);
        if (!file) return; // OpenEXR says so
        if (!failed && size > length)
            throw Error(ErrorKind::input, fmt::format("is damaged: attribute {} has {} bytes, more than the file", name, size), path);
        file.seekg(static_cast<std::streamoff>(size), std::ios::cur);
    }
}

} // namespace clvr
