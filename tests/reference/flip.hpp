// LDR-FLIP with whole two-dimensional kernels, as the paper writes it (Andersson et al. 2020).
#pragma once
#include <array>
#include <vector>

namespace clvr::reference {

/// Per pixel, of linear light rgb[height * width] within 0..1, for 67.02 pixels per degree.
std::vector<double> flip(const std::vector<std::array<double, 3>>& image, const std::vector<std::array<double, 3>>& reference, int width,
                         int height);

} // namespace clvr::reference
