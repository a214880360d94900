// A finished picture with its channels, as the renderer makes it and EXR files hold it.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace clvr {

/// Channels are planar float32, row 0 on top, width*height values each, named as in DESIGN.md section 4 "Frames":
/// R G B A (linear, premultiplied), albedo.R ..., normal.X ..., depth.Z, opacity.A, depth.deviation, depth.half, variance.R ...,
/// background.R ...
struct Frame {
    int width = 0, height = 0;
    std::map<std::string, std::vector<float>> channels;
    std::map<std::string, std::string>
        attributes; ///< provenance: "clvr.volume.sha256", "clvr.scene", "clvr.seed", "clvr.spp", "clvr.device", ...

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
    /// The opacity with which the picture is shown: A; null where it is opaque, as it has none or lies over a background (background.R ...;
    /// A is the camera rays' opacity there, too).
    const std::vector<float>* shown_alpha() const { return has("background.R") ? nullptr : find("A"); }
    /// The best that is known of the camera rays' opacity: opacity.A (free of noise), else A, else null.
    const std::vector<float>* opacity() const { return has("opacity.A") ? find("opacity.A") : find("A"); }
};

/// SHA-256 (hex) over size, channel names in order and the bits of every pixel; attributes do not count.
std::string pixel_hash(const Frame& frame);

} // namespace clvr
