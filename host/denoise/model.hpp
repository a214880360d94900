// The network of the neural bilateral grid, with all that a model file says of its use.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace clvr {

/// GuideNet (Meng et al. 2020; kernels/denoise/README.md, "Network"): conv kernel x kernel (C_in -> hidden), leaky ReLU 0.2, conv (hidden
/// -> outputs()), sigmoid: a guide per level, then a blending weight per level but the last. Tensors are OIHW, row-major.
struct Model {
    /// Sampling factors of a bilateral grid: pixels per cell (both ways), codes of the guide's 256 per cell.
    struct Level {
        int pixels = 4, codes = 4;
    };

    /// Input channels in order, by their names in frames (host/README.md, "Frames"). R, G, B (premultiplied beauty) are tone mapped,
    /// normal.* becomes (n+1)/2, "noise" is (samples per pixel)^(-1/2), "known.R" ... (KnownLight) are tone mapped, the rest is taken as it
    /// is.
    std::vector<std::string> channels;
    int hidden = 20;
    int kernel = 5; ///< odd
    std::vector<Level> levels{{4, 4}, {8, 8}, {16, 16}};

    // Preprocessing beyond the published method (kernels/denoise/README.md, "Switches"); absent from a file means these values.
    bool exposure = false;                    ///< radiance scaled by 0.18 / exp2(mean log2 luminance), clamped at 32
    float albedo_floor = 0x1p-20f;            ///< radiance is divided and remultiplied by max(albedo, this)
    bool demodulation = true;                 ///< where the channels have the three of albedo; false: radiance is taken as it is
    bool control_variate = false;             ///< what is known of the light (known_light.hpp) is taken off before the grids, added after
    int control_variate_cell = 0;             ///< KnownLight's `cell`: 0, or 8 to 256 pixels
    bool opacity_weight = false;              ///< a pixel counts in the splat by its opacity.A, and the output is times that
    std::map<std::string, std::string> notes; ///< further metadata ("clvr.training", ...): how it was made; kept when the file is copied

    std::vector<float> conv1_weight; ///< [hidden, channels, kernel, kernel]
    std::vector<float> conv1_bias;   ///< [hidden]
    std::vector<float> conv2_weight; ///< [outputs(), hidden, kernel, kernel]
    std::vector<float> conv2_bias;   ///< [outputs()]

    int outputs() const { return 2 * static_cast<int>(levels.size()) - 1; }
    std::size_t parameters() const { return conv1_weight.size() + conv1_bias.size() + conv2_weight.size() + conv2_bias.size(); }
    /// All parameters in the order conv1.weight, conv1.bias, conv2.weight, conv2.bias.
    std::vector<float> flat() const;
    /// Takes what flat() gave. The sizes must agree.
    void set_flat(const std::vector<float>& parameters);
};

/// Channels of a file with tensors alone and C_in = 10: R G B, albedo.R G B, normal.X Y Z, depth.Z.
std::vector<std::string> reference_channels();

/// clvr's own choice for a new network: channels, sizes and switches, without tensors. The evidence is datasets/results/ablation.md.
Model default_settings();

/// Sizes the tensors and draws them as the reference does: Glorot uniform kernels, zero biases. The same bits for a seed on every machine.
void initialise(Model& model, std::uint64_t seed);

/// Makes the model subtract the known light before its grids (with shares that vary over cells of 32 pixels) and read it as three more
/// channels. Their weights begin at 0, so until the model is trained further its guides are what they were. A model that does this already
/// only gets the cells.
void add_known_light(Model& model);

/// Throws Error{input} naming the first thing that is wrong: no channels, unknown or doubled ones, sizes out of range (channels 1..64,
/// hidden 1..256, kernel odd 1..15, levels 1..8 with pixels 1..64 and codes 4..256), tensors of other sizes, non-finite weights.
void validate(const Model& model);

/// The part of validate that concerns the levels.
void validate_levels(const std::vector<Model::Level>& levels);

} // namespace clvr
