#include "host/frame/display_pixels.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <fmt/format.h>
#include <memory>
#include <turbojpeg.h>

namespace clvr {

namespace {

constexpr int largest_side = 65500; // libjpeg's JPEG_MAX_DIMENSION
constexpr std::size_t largest_jpeg_pixels = std::size_t{1} << 28;

using Handle = std::unique_ptr<void, int (*)(tjhandle)>;

Handle checked(tjhandle handle) {
    if (!handle) throw Error(ErrorKind::host_memory, "there is no memory for libjpeg-turbo");
    return {handle, tjDestroy};
}

void refuse_large(int width, int height, const std::string& path) {
    if (width > largest_side || height > largest_side)
        throw Error(ErrorKind::input,
                    fmt::format("{} x {} pixels are too many for JPEG, which ends at {}; name a .png", width, height, largest_side), path);
}

} // namespace

void write_jpeg(const Frame& frame, const Tonemap& tonemap, const std::string& path) {
    const Region shown = frame.shown();
    refuse_large(shown.width, shown.height, path); // before pixels of that size are made
    try {
        write_jpeg(display_pixels(frame, tonemap, false), path);
    } catch (const Error& e) {
        throw e.where().empty() ? Error(e.kind(), e.what(), path) : e;
    }
}

std::vector<unsigned char> encode_jpeg(const DisplayPixels& pixels, const JpegQuality& quality) {
    const Handle encoder = checked(tjInitCompress());
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    const int failed = tjCompress2(encoder.get(), pixels.values.data(), pixels.width, 0, pixels.height, TJPF_RGB, &bytes, &size,
                                   quality.full_colour ? TJSAMP_444 : TJSAMP_420, quality.percent, TJFLAG_ACCURATEDCT);
    const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, tjFree);
    if (failed != 0) throw Error(ErrorKind::internal, fmt::format("libjpeg-turbo cannot encode: {}", tjGetErrorStr2(encoder.get())));
    return {bytes, bytes + size};
}

void write_jpeg(const DisplayPixels& pixels, const std::string& path) {
    refuse_large(pixels.width, pixels.height, path);
    const std::vector<unsigned char> encoded = encode_jpeg(pixels);
    write_atomically(path, encoded.data(), encoded.size());
}

Frame read_jpeg(const std::string& path) {
    const std::string bytes = read_text(path, std::size_t{1} << 30);
    const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
    const Handle decoder = checked(tjInitDecompress());
    const auto refuse = [&](const char* what) {
        return Error(ErrorKind::input, fmt::format("{}: {}", what, tjGetErrorStr2(decoder.get())), path);
    };
    DisplayPixels pixels;
    int sampling = 0, colours = 0;
    if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &pixels.width, &pixels.height, &sampling, &colours) != 0)
        throw refuse("is no JPEG that clvr reads");
    if (colours == TJCS_CMYK || colours == TJCS_YCCK) throw Error(ErrorKind::input, "is a JPEG of inks (CMYK); save it as RGB", path);
    const std::size_t count = static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height);
    if (count > largest_jpeg_pixels)
        throw Error(ErrorKind::input, fmt::format("is {} x {} pixels; expected at most 2^28 in all", pixels.width, pixels.height), path);
    pixels.values.resize(3 * count);
    if (tjDecompress2(decoder.get(), data, bytes.size(), pixels.values.data(), pixels.width, 0, pixels.height, TJPF_RGB,
                      TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0)
        throw refuse("is a damaged JPEG");
    return frame_of(pixels);
}

} // namespace clvr
