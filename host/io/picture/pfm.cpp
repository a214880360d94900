#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>

namespace clvr {

Frame read_pfm(const std::string& path) {
    const std::string bytes = read_text(path, (std::size_t{1} << 32) + 1024);
    const auto refuse = [&](const std::string& what) { return Error(ErrorKind::input, what, path); };
    Frame frame;
    char kind = 0;
    double scale = 0;
    int end = 0;
    const std::string header = bytes.substr(0, 256); // sscanf would walk the whole file for its end
    if (std::sscanf(header.c_str(), "P%c %d %d %lf%n", &kind, &frame.width, &frame.height, &scale, &end) != 4 ||
        (kind != 'F' && kind != 'f'))
        throw refuse("is no PFM image: expected PF, width, height and scale");
    std::size_t at = static_cast<std::size_t>(end);
    if (bytes.compare(at, 2, "\r\n") == 0) ++at; // one blank ends the header
    ++at;
    constexpr int most = 1 << 16;
    if (frame.width < 1 || frame.height < 1 || frame.width > most || frame.height > most || frame.pixels() > (std::size_t{1} << 28))
        throw refuse(fmt::format("has {} x {} pixels; expected 1 x 1 to 16384 x 16384", frame.width, frame.height));
    if (scale == 0 || !std::isfinite(scale))
        throw refuse(fmt::format("has the scale {}; expected a number, negative for little endian", scale));
    const std::size_t components = kind == 'F' ? 3 : 1, needed = 4 * components * frame.pixels();
    if (bytes.size() < at + needed)
        throw refuse(fmt::format("is no complete PFM image: {} bytes are missing at its end", at + needed - bytes.size()));
    const float factor = static_cast<float>(std::abs(scale));
    if (factor != 1) frame.notes.push_back(fmt::format("its values are multiplied by its scale {}", factor));
    if (components == 1) frame.notes.push_back("is grey: taken as R, G and B");
    const std::size_t width = static_cast<std::size_t>(frame.width);
    const char* names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float>& plane = frame.channel(names[c]);
        for (std::size_t i = 0; i < plane.size(); ++i) {
            const std::size_t row = static_cast<std::size_t>(frame.height) - 1 - i / width; // the file's first row is the lowest
            char value[4];
            std::memcpy(value, &bytes[at + 4 * (components * (row * width + i % width) + std::min(c, components - 1))], 4);
            if (scale > 0) std::reverse(value, value + 4);
            std::memcpy(&plane[i], value, 4);
            plane[i] *= factor;
        }
    }
    return frame;
}

} // namespace clvr
