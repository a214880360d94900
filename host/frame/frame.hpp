// A finished picture with its channels, as the renderer makes it and EXR files hold it.
#pragma once
#include "host/frame/names.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// The channels of a picture's colour.
inline constexpr channel::Names colour_channels = channel::colour;

/// Part of a picture [pixels].
struct Region {
    int x = 0, y = 0, width = 0, height = 0;
    std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
    friend bool operator==(const Region& a, const Region& b) {
        return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
    }
    friend bool operator!=(const Region& a, const Region& b) { return !(a == b); }
};

/// Channels are planar float32, row 0 on top, width*height values each; their names are in host/README.md, "Frames".
struct Frame {
    /// A value of a file that is no text, kept for the next file: its bytes as OpenEXR writes them.
    struct Attribute {
        std::string type, bytes;
        bool operator==(const Attribute& other) const { return type == other.type && bytes == other.bytes; }
    };

    int width = 0, height = 0;
    int x = 0, y = 0;              ///< of the first pixel: a crop's place in the whole picture, below 0 for what lies beyond its edge
    std::optional<Region> display; ///< the whole picture, where that is not the frame itself (OpenEXR's display window)
    float pixel_aspect = 1;        ///< width of a pixel over its height
    std::map<std::string, std::vector<float>> channels;
    std::map<std::string, std::string> attributes; ///< provenance, by the names of names.hpp
    std::map<std::string, Attribute> further;      ///< of a file that was read: chromaticities, worldToCamera, ...
    std::vector<std::string> notes; ///< what its reader understood in a way that may surprise, a sentence each; commands print them

    std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
    bool has(const std::string& name) const { return channels.count(name) != 0; }
    const std::vector<float>& at(const std::string& name) const { return channels.at(name); }
    /// The channel, or null.
    const std::vector<float>* find(const std::string& name) const {
        const auto found = channels.find(name);
        return found == channels.end() ? nullptr : &found->second;
    }
    /// The channel, made (all 0) when absent.
    std::vector<float>& channel(const std::string& name) {
        auto& c = channels[name];
        c.resize(pixels());
        return c;
    }
    Region window() const { return {x, y, width, height}; }
    /// The part of the plane that a picture for people shows; pixels of it outside window() are black and clear.
    Region shown() const { return display.value_or(window()); }
    /// A frame of the same size and place without channels.
    Frame blank() const {
        Frame f;
        f.width = width, f.height = height, f.x = x, f.y = y, f.display = display, f.pixel_aspect = pixel_aspect;
        return f;
    }
    /// The opacity with which the picture is shown: A, or null where the picture is opaque. It is opaque when it has no A, and when it lies
    /// over a background (background.R ...; A is the camera rays' opacity there, too).
    const std::vector<float>* shown_alpha() const { return has(channel::background[0]) ? nullptr : find(channel::alpha); }
    /// The best that is known of the camera rays' opacity: opacity.A (free of noise), else A, else null.
    const std::vector<float>* opacity() const { return has(channel::opacity) ? find(channel::opacity) : find(channel::alpha); }
};

/// The frame cut to shown(), with 0 in all channels where it has no pixels, and that part's corner as (0, 0). Throws Error{input}
/// when that is more than 65536 pixels a side, or 2^28.
Frame shown_part(const Frame& frame);

/// SHA-256 (hex) over size, channel names in order and the bits of every pixel; attributes do not count.
std::string pixel_hash(const Frame& frame);

} // namespace clvr
