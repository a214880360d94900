#include "host/frame/frame.hpp"
#include "runtime/error.hpp"
#include "runtime/system/hashes.hpp"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>

namespace clvr {

namespace {

constexpr std::size_t largest_shown = std::size_t{1} << 28; // 16384 x 16384, the largest picture that clvr renders
constexpr int largest_shown_side = 65536;

} // namespace

Frame shown_part(const Frame& frame) {
    const Region to = frame.shown(), from = frame.window();
    if (std::max(to.width, to.height) > largest_shown_side || to.pixels() > largest_shown)
        throw Error(ErrorKind::input, fmt::format("shows {} x {} pixels (its display window); expected at most {} a side, 2^28 in all",
                                                  to.width, to.height, largest_shown_side));
    Frame part = frame.blank();
    part.x = 0, part.y = 0, part.width = to.width, part.height = to.height;
    part.display.reset();
    part.attributes = frame.attributes, part.further = frame.further, part.notes = frame.notes;
    const int left = std::max(to.x, from.x), right = std::min(to.x + to.width, from.x + from.width);
    const int top = std::max(to.y, from.y), bottom = std::min(to.y + to.height, from.y + from.height);
    for (const auto& [name, values] : frame.channels) {
        std::vector<float>& cut = part.channel(name);
        for (int y = top; y < bottom && left < right; ++y) {
            const auto row = values.begin() + static_cast<std::ptrdiff_t>(y - from.y) * from.width;
            std::copy(row + (left - from.x), row + (right - from.x),
                      cut.begin() + static_cast<std::ptrdiff_t>(y - to.y) * to.width + (left - to.x));
        }
    }
    return part;
}

std::string pixel_hash(const Frame& frame) {
    Hash hash;
    const std::uint32_t size[2] = {static_cast<std::uint32_t>(frame.width), static_cast<std::uint32_t>(frame.height)};
    hash.add(size, sizeof size);
    for (const auto& [name, values] : frame.channels) {
        hash.add(name.c_str(), name.size() + 1);
        hash.add(values.data(), values.size() * sizeof(float));
    }
    return hash.hex();
}

} // namespace clvr
