// How the renderer numbers the pixels of a picture: in 4x4 blocks, row by row of blocks, as kernels/lib/paths.clh does.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace clvr {

/// How many numbers a picture has: those of whole blocks, also where they reach beyond its border.
inline std::uint32_t pixel_numbers(int width, int height) { return (width + 3u) / 4 * ((height + 3u) / 4) * 16; }

/// x, y of a pixel number.
inline std::array<std::uint32_t, 2> pixel_of(std::uint32_t number, int width) {
    const std::uint32_t blocks_x = (width + 3u) / 4, block = number / 16;
    return {block % blocks_x * 4 + number % 4, block / blocks_x * 4 + number / 4 % 4};
}

/// Calls put(pixel number, index in the picture's rows) for every pixel of the picture.
template <class F>
void for_pixels(int width, int height, F&& put) {
    for (std::uint32_t i = 0; i < pixel_numbers(width, height); ++i) {
        const auto [x, y] = pixel_of(i, width);
        if (x < static_cast<std::uint32_t>(width) && y < static_cast<std::uint32_t>(height))
            put(i, static_cast<std::size_t>(y) * width + x);
    }
}

} // namespace clvr
