// Random numbers in plain integers: Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011), and Sobol's points scrambled by hashing (Burley 2020),
// from the papers.
#pragma once
#include <array>
#include <cstdint>

namespace clvr::reference {

/// The block of four numbers for a counter and a key.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// The point of a sample in the set that a pixel of a frame has for a purpose, as 32-bit fractions.
std::array<std::uint32_t, 2> sobol(std::uint32_t pixel, std::uint32_t sample, std::uint32_t purpose, std::array<std::uint32_t, 2> key);

} // namespace clvr::reference
