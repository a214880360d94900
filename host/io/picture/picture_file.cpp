#include "host/io/file_roles.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace clvr {

namespace {

/// In lower case.
std::string ending_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

} // namespace

PictureFormat picture_format(const std::string& path) {
    check_readable(path);
    std::string magic(8, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    magic.resize(static_cast<std::size_t>(file.gcount()));
    const auto begins = [&](const char* with, std::size_t size) { return magic.compare(0, size, with, size) == 0; };
    if (begins("\x76\x2f\x31\x01", 4)) return PictureFormat::exr;
    if (begins("\x89PNG", 4)) return PictureFormat::png;
    if (begins("\xff\xd8\xff", 3)) return PictureFormat::jpeg;
    if (begins("#?", 2)) return PictureFormat::radiance;
    if (begins("PF\n", 3) || begins("Pf\n", 3) || begins("PF\r", 3) || begins("Pf\r", 3)) return PictureFormat::pfm;
    throw Error(ErrorKind::input, "is no picture that clvr reads: OpenEXR, Radiance .hdr, PFM, PNG or JPEG", path);
}

Frame read_picture(const std::string& path) {
    will_read(path);
    switch (picture_format(path)) {
    case PictureFormat::exr:
        return read_exr(path);
    case PictureFormat::png:
        return read_png(path);
    case PictureFormat::jpeg:
        return read_jpeg(path);
    case PictureFormat::radiance:
        return read_radiance(path);
    case PictureFormat::pfm:
        return read_pfm(path);
    }
    throw Error(ErrorKind::internal, "a picture of no format", path);
}

bool is_display_light(PictureFormat format) { return format == PictureFormat::png || format == PictureFormat::jpeg; }

bool is_exr_path(const std::string& path) { return ending_of(path) == ".exr"; }

bool is_jpeg_path(const std::string& path) { return ending_of(path) == ".jpg" || ending_of(path) == ".jpeg"; }

void check_frame_path(const std::string& path) {
    const std::string ending = ending_of(path);
    if (ending != ".png" && !is_jpeg_path(path) && !is_exr_path(path))
        throw Error(ErrorKind::input, fmt::format("has the ending '{}'; expected .png or .jpg (a picture) or .exr (all channels)", ending),
                    path);
    check_writable(path);
}

void write_frame(const Frame& frame, const Tonemap& tonemap, const std::string& path) {
    if (is_exr_path(path))
        write_exr(frame, path);
    else if (is_jpeg_path(path))
        write_jpeg(frame, tonemap, path);
    else
        write_png(frame, tonemap, path);
}

} // namespace clvr
