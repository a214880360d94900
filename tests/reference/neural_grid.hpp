// The neural bilateral grid in double precision, forward and backward, one image, loop by loop as kernels/denoise/README.md
// writes it, from "Network" to "Backward".
#pragma once
#include <utility>
#include <vector>

namespace clvr::reference {

/// kernels/denoise/README.md, "Loss"
enum class GridLoss { shifted_gamma, reference, smape, relative_l2, noisy, shifted_gamma_l2, shifted_gamma_bands };

struct Network {
    int channels = 0, hidden = 0, kernel = 5;
    std::vector<std::pair<int, int>> levels; ///< pixels per cell, codes per cell
    std::vector<double> parameters;          ///< conv1.weight, conv1.bias, conv2.weight, conv2.bias; OIHW

    int outputs() const { return 2 * static_cast<int>(levels.size()) - 1; }
};

struct GridImage {
    int height = 0, width = 0;
    std::vector<double> input;        ///< [channels][pixels]
    std::vector<double> splatted;     ///< [pixels][4]: colour times weight (what N sums), weight (what D sums)
    std::vector<double> remodulation; ///< [pixels][3]
    std::vector<double> known;        ///< [pixels][3], added to the result; empty: 0
    std::vector<double> target;       ///< [pixels][3]
};

struct GridPass {
    double loss = 0;
    std::vector<double> outputs;  ///< [outputs][pixels], after the sigmoid
    std::vector<double> result;   ///< [pixels][3]
    std::vector<double> gradient; ///< of the loss by the parameters; empty for the forward pass alone
    /// Which side of each kink everything lies on: signs before the leaky ReLU, depth cells, signs of errors, branches of the loss.
    /// The loss is smooth where this does not change.
    std::vector<int> sides;
};

GridPass forward(const Network& network, const GridImage& image, GridLoss loss);
GridPass backward(const Network& network, const GridImage& image, GridLoss loss);

} // namespace clvr::reference
