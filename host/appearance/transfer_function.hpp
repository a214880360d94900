// Physical value -> colour and opacity.
#pragma once
#include "host/volume/voxels.hpp"

#include <array>
#include <string>
#include <vector>

namespace clvr {

/// Number of entries of the device table.
constexpr int transfer_entries = 4096;

/// Piecewise linear classification (after interpolation). Points ascend in value; two points at one value make a step, which the table
/// turns into a ramp of one entry. Outside [first, last] the end points hold, colour and opacity: an end with opacity 0 shows nothing
/// beyond it.
struct TransferFunction {
    struct Point {
        double value;                ///< physical value, or 0..1 of the volume's range when `normalized`
        std::array<double, 3> color; ///< linear RGB, 0..1: single-scattering albedo
        double opacity;              ///< 0..1: extinction as a share of the scene's greatest
    };
    bool normalized = false;
    std::vector<Point> points;
    std::string name; ///< preset name, file, or "auto"
};

/// The device table over stored values: entry e stands for stored value first + e * (last - first) / 4095.
struct TransferTable {
    double first = 0, last = 1; ///< stored values of entry 0 and of the last entry; first < last
    std::vector<float> opacity; ///< [4096]
    std::vector<float> color;   ///< [4096 * 4], linear RGB and 0
    /// Width of the value interval with opacity > 0 inside [first, last], in stored values; 0: nothing in the volume's range is visible.
    double visible_width = 0;
    double index_scale() const { return (transfer_entries - 1) / (last - first); }
};

/// Throws Error{input} with `where` unless there is a point, all numbers are finite, values ascend, colours and opacities lie in 0..1.
void validate(const TransferFunction& tf, const std::string& where);

/// Tabulates `tf` for a volume whose stored values span `low`..`high`. Computed in double, rounded once, without libm.
/// A negative slope reverses the value axis; 0..1 of a normalized one is the physical range, low to high. One point, or all at one value,
/// make a table of small width around it. Throws Error{input} for an invalid transfer function.
TransferTable tabulate(const TransferFunction& tf, const Voxels& v, double low, double high);

/// Reads clvr's JSON (host/README.md, "Transfer function") or a ParaView colour-map JSON. `where` names the source in errors. Throws
/// Error{input}.
TransferFunction parse_transfer_function(const std::string& json_text, const std::string& where);
/// clvr's JSON, linear colours, every number with the digits that read back to the same bits.
std::string to_json(const TransferFunction& tf);

/// Names and one-line descriptions of the built-in presets (ct-bone, ct-soft-tissue, ct-angio, ct-lung, mr, generic, ...).
struct Preset {
    std::string name, description;
};
std::vector<Preset> transfer_presets();
/// A preset by name. Throws Error{usage} listing the names.
TransferFunction transfer_preset(const std::string& name);

/// The default where no choice was made: built from the histogram, so that air and background vanish and structure shows.
/// Deterministic in the voxels alone.
TransferFunction automatic_transfer_function(const Voxels& v, const Histogram& h);

} // namespace clvr
