#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <string_view>

namespace clvr {

namespace {

constexpr std::size_t largest_bytes = std::size_t{1} << 30; // a 16384 x 8192 Radiance file without compression has half of this
constexpr int largest_image_side = 16384;

[[noreturn]] void refuse_radiance(const std::string& what) { throw Error(ErrorKind::input, what); }

/// Takes lines and bytes off the front of a Radiance file; refuses to go past its end.
struct Cursor {
    std::string_view left;
    std::string_view line() {
        const std::size_t end = left.find('\n');
        if (end == left.npos) refuse_radiance("is no complete Radiance image: its header has no end");
        std::string_view taken = left.substr(0, end);
        left.remove_prefix(end + 1);
        while (!taken.empty() && (taken.back() == '\r' || taken.back() == ' ')) taken.remove_suffix(1);
        return taken;
    }
    std::string_view take(std::size_t n) {
        if (left.size() < n)
            refuse_radiance(fmt::format("is no complete Radiance image: {} bytes or more are missing at its end", n - left.size()));
        const std::string_view taken = left.substr(0, n);
        left.remove_prefix(n);
        return taken;
    }
    unsigned char byte() { return static_cast<unsigned char>(take(1)[0]); }
};

/// What the header says of the values and their place.
struct Header {
    std::array<double, 3> factor{1, 1, 1}; ///< the product of all EXPOSURE and COLORCORR: radiance is the stored value over this
    double aspect = 1;                     ///< height of a pixel over its width
    bool corrected = false, other_primaries = false;
    int lines = 0, line_pixels = 0; ///< scanlines, and pixels of each
    bool upright = true;            ///< scanlines are rows
    bool line_back = false;         ///< the first scanline is the lowest row, or the rightmost column
    bool pixel_back = false;        ///< the first pixel of a scanline is its rightmost, or lowest
    int width() const { return upright ? line_pixels : lines; }
    int height() const { return upright ? lines : line_pixels; }
};

/// So many positive numbers after the "=".
template <std::size_t N>
std::array<double, N> positive(std::string_view line, std::size_t sign) {
    std::array<double, N> values{};
    const std::string text(line.substr(sign + 1, 256));
    const char* at = text.c_str();
    for (double& value : values) {
        char* end = nullptr;
        value = std::strtod(at, &end);
        if (end == at || !(value > 0) || !std::isfinite(value))
            refuse_radiance(fmt::format("has the line '{}'; expected positive numbers", line.substr(0, 80)));
        at = end;
    }
    return values;
}

void read_resolution(const std::string& line, Header& h) {
    char sign[2], axis[2];
    int count[2], end = 0;
    const bool read =
        std::sscanf(line.c_str(), "%c%c %d %c%c %d%n", &sign[0], &axis[0], &count[0], &sign[1], &axis[1], &count[1], &end) == 6 &&
        line[static_cast<std::size_t>(end)] == '\0';
    const auto known = [](char s, char a) { return (s == '-' || s == '+') && (a == 'X' || a == 'Y'); };
    if (!read || !known(sign[0], axis[0]) || !known(sign[1], axis[1]) || axis[0] == axis[1])
        refuse_radiance(fmt::format("has the resolution line '{}'; expected '-Y height +X width'", line));
    h.upright = axis[0] == 'Y';
    // -Y goes down and +X to the right, as rows and columns do here
    const auto back = [&](int k) { return sign[k] == (axis[k] == 'Y' ? '+' : '-'); };
    h.line_back = back(0), h.pixel_back = back(1);
    h.lines = count[0], h.line_pixels = count[1];
    if (h.lines < 1 || h.line_pixels < 1 || h.lines > largest_image_side || h.line_pixels > largest_image_side)
        refuse_radiance(
            fmt::format("has {} x {} pixels; expected 1 x 1 to {} x {}", h.width(), h.height(), largest_image_side, largest_image_side));
}

Header read_header(Cursor& at) {
    if (const auto magic = at.line(); magic != "#?RADIANCE" && magic != "#?RGBE")
        refuse_radiance("is no Radiance image: its first line is not #?RADIANCE");
    Header h;
    bool rgbe = false;
    for (std::string_view line = at.line(); !line.empty(); line = at.line()) {
        const std::size_t sign = line.find('=');
        const std::string_view name = line.substr(0, sign);
        if (sign == line.npos) continue;
        if (name == "FORMAT") {
            rgbe = line.substr(sign + 1) == "32-bit_rle_rgbe";
        } else if (name == "EXPOSURE") {
            for (double& f : h.factor) f *= positive<1>(line, sign)[0];
            h.corrected = true;
        } else if (name == "COLORCORR") {
            const auto colours = positive<3>(line, sign);
            for (std::size_t c = 0; c < 3; ++c) h.factor[c] *= colours[c];
            h.corrected = true;
        } else if (name == "PIXASPECT") {
            h.aspect *= positive<1>(line, sign)[0];
        } else if (name == "PRIMARIES") {
            h.other_primaries = true;
        }
    }
    if (!rgbe) refuse_radiance("has another pixel format than 32-bit_rle_rgbe");
    for (const double f : h.factor)
        if (!(f > 1e-30 && f < 1e30)) refuse_radiance(fmt::format("has EXPOSURE and COLORCORR lines that multiply to {}", f));
    read_resolution(std::string(at.line().substr(0, 64)), h);
    return h;
}

/// One scanline, R G B E a pixel, in any of the three codings; `y` names it in errors.
void read_line(Cursor& at, std::vector<unsigned char>& rgbe, std::size_t y) {
    const std::size_t row = rgbe.size() / 4;
    const std::string_view start = at.left.substr(0, 4);
    const bool runs = row >= 8 && row < 32768 && start.size() == 4 && start[0] == 2 && start[1] == 2 && !(start[2] & 0x80);
    if (!runs) { // pixel by pixel; 1 1 1 n repeats the one before, several in a row are the bytes of a larger n
        int shift = 0;
        for (std::size_t x = 0; x < row;) {
            const std::string_view p = at.take(4);
            if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
                const std::size_t n = shift < 24 ? static_cast<std::size_t>(static_cast<unsigned char>(p[3])) << shift : row + 1;
                if (x == 0 || n > row - x) refuse_radiance(fmt::format("is damaged: a run of {} pixels in line {} from pixel {}", n, y, x));
                for (std::size_t k = 0; k < 4 * n; ++k) rgbe[4 * x + k] = rgbe[4 * x + k - 4];
                x += n, shift += 8;
            } else {
                for (std::size_t k = 0; k < 4; ++k) rgbe[4 * x + k] = static_cast<unsigned char>(p[k]);
                ++x, shift = 0;
            }
        }
        return;
    }
    at.take(4);
    if ((static_cast<std::size_t>(static_cast<unsigned char>(start[2])) << 8 | static_cast<unsigned char>(start[3])) != row)
        refuse_radiance(fmt::format("is damaged: line {} does not start with its width", y));
    for (std::size_t component = 0; component < 4; ++component)
        for (std::size_t x = 0; x < row;) {
            const unsigned code = at.byte();
            const std::size_t length = code > 128 ? code - 128 : code;
            if (length == 0 || length > row - x)
                refuse_radiance(fmt::format("is damaged: a run of {} pixels in line {} from pixel {}", length, y, x));
            const std::string_view values = at.take(code > 128 ? 1 : length);
            for (std::size_t k = 0; k < length; ++k, ++x) rgbe[4 * x + component] = static_cast<unsigned char>(values[code > 128 ? 0 : k]);
        }
}

void describe(const Header& h, Frame& frame) {
    frame.pixel_aspect = static_cast<float>(1 / h.aspect);
    if (h.corrected)
        frame.notes.push_back(fmt::format("its values are divided by EXPOSURE and COLORCORR of its header, {:.6g} {:.6g} {:.6g}",
                                          h.factor[0], h.factor[1], h.factor[2]));
    if (h.other_primaries) frame.notes.push_back("its colours have PRIMARIES of their own: taken as they are");
    if (!h.upright || h.line_back || h.pixel_back) frame.notes.push_back("its scanlines are turned as its resolution line says");
}

Frame decode(const std::string& bytes) {
    Cursor at{bytes};
    const Header h = read_header(at);
    std::vector<unsigned char> line(4 * static_cast<std::size_t>(h.line_pixels)), all;
    for (int y = 0; y < h.lines; ++y) { // memory grows with what the file holds, so a short file that promises much ends here
        read_line(at, line, static_cast<std::size_t>(y));
        all.insert(all.end(), line.begin(), line.end());
    }
    Frame frame;
    frame.width = h.width(), frame.height = h.height();
    describe(h, frame);
    const char* names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float>& plane = frame.channel(names[c]);
        for (int l = 0; l < h.lines; ++l)
            for (int p = 0; p < h.line_pixels; ++p) {
                const int line_at = h.line_back ? h.lines - 1 - l : l, pixel_at = h.pixel_back ? h.line_pixels - 1 - p : p;
                const int x = h.upright ? pixel_at : line_at, y = h.upright ? line_at : pixel_at;
                const unsigned char* const rgbe =
                    &all[4 * (static_cast<std::size_t>(l) * static_cast<std::size_t>(h.line_pixels) + static_cast<std::size_t>(p))];
                const float stored = rgbe[3] == 0 ? 0 : std::ldexp(static_cast<float>(rgbe[c]), rgbe[3] - (128 + 8));
                plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x)] =
                    h.corrected ? static_cast<float>(stored / h.factor[c]) : stored;
            }
    }
    return frame;
}

} // namespace

Frame read_radiance(const std::string& path) {
    try {
        return decode(read_text(path, largest_bytes));
    } catch (const Error& e) {
        throw Error(e.kind(), e.what(), path);
    }
}

} // namespace clvr
