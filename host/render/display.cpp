#include "host/render/display.hpp"
#include "host/render/pixel_numbers.hpp"
#include "host/render/two_floats.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clvr {

Display::Display(const Device& device) : device_(device), kernel_(device_.kernel("render/display")) {
    std::vector<std::array<float, 2>> least;
    for (const auto* codes : {&least_of_srgb_codes(), &least_of_alpha_codes()})
        for (const double v : *codes) least.push_back(two_floats(v));
    least_ = device_.upload(least, "values of 8-bit codes");
}

DisplayPixels Display::show(Film& film, const Behind& behind, const Tonemap& tonemap, bool alpha) {
    const ToneCurve known(tonemap); // or it throws
    const auto curve = std::find(tonemap_names.begin(), tonemap_names.end(), tonemap.curve) - tonemap_names.begin();
    const auto gain = two_floats(std::exp2(tonemap.exposure));
    const std::size_t bytes = 4 * film.pixels();
    if (pixels_.bytes() != bytes) pixels_ = device_.buffer(bytes, "picture to show");
    const std::uint32_t numbers = pixel_numbers(film.width(), film.height());
    const int over = behind.picture ? 1 : behind.opaque ? 2 : 0;
    device_.launch(kernel_, {numbers}, kernel_.group(64), {20.0 * numbers, 0}, film.planes(), static_cast<cl_uint>(film.find("R")),
                   behind.picture ? *behind.picture : film.planes(), over, behind.colour, film.width(), film.height(),
                   static_cast<cl_int>(curve), gain[0], gain[1], least_, static_cast<cl_int>(alpha), pixels_);
    DisplayPixels shown{film.width(), film.height(), 4, std::vector<unsigned char>(bytes)};
    device_.read(pixels_, shown.values.data(), bytes);
    return without_needless_alpha(std::move(shown), alpha);
}

} // namespace clvr
