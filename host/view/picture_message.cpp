#include "host/view/picture_message.hpp"
#include "host/io/picture/frame_file.hpp"

namespace clvr::view {

namespace {

constexpr std::uint32_t magic = 0x52564c43; // "CLVR"
constexpr std::uint8_t jpeg_format = 0, png_format = 1;

/// Little-endian.
template <class T>
void append(std::string& to, T value) {
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) to += static_cast<char>(value >> 8 * byte & 0xff);
}

std::string header(const LivePicture& picture, int width, int height) {
    std::string bytes;
    append(bytes, magic);
    append(bytes, static_cast<std::uint32_t>(picture.number));
    append(bytes, picture.generation);
    append(bytes, static_cast<std::uint32_t>(picture.samples));
    for (const int side : {picture.pixels.width, picture.pixels.height, width, height}) append(bytes, static_cast<std::uint16_t>(side));
    append(bytes, static_cast<std::uint8_t>(picture.divider));
    append(bytes, picture.phase == Phase::settled ? png_format : jpeg_format);
    append(bytes, static_cast<std::uint8_t>(picture.phase));
    append(bytes, std::uint8_t{0});
    return bytes;
}

/// Three components: the code times alpha, as browsers mix.
DisplayPixels over_black(const DisplayPixels& pixels) {
    DisplayPixels opaque{pixels.width, pixels.height, 3, {}};
    opaque.values.resize(pixels.values.size() / 4 * 3);
    const unsigned char* from = pixels.values.data();
    for (unsigned char* to = opaque.values.data(); to != opaque.values.data() + opaque.values.size(); to += 3, from += 4)
        for (int c = 0; c < 3; ++c) to[c] = static_cast<unsigned char>((from[c] * from[3] + 127) / 255);
    return opaque;
}

std::vector<unsigned char> encoded_pixels(const LivePicture& picture) {
    if (picture.phase == Phase::settled) return encode_png(picture.pixels, PngEffort::quick);
    // Small pictures are shown enlarged, and their errors with them; they take few bytes.
    const bool fast = picture.phase == Phase::moving && picture.divider == 1;
    const JpegQuality quality = fast ? JpegQuality{80, false} : JpegQuality{92, true};
    return encode_jpeg(picture.pixels.components == 4 ? over_black(picture.pixels) : picture.pixels, quality);
}

} // namespace

EncodedPicture encode(const LivePicture& picture, int width, int height) {
    const std::vector<unsigned char> pixels = encoded_pixels(picture);
    EncodedPicture encoded{static_cast<std::uint32_t>(picture.number), header(picture, width, height)};
    encoded.bytes.append(pixels.begin(), pixels.end());
    return encoded;
}

} // namespace clvr::view
