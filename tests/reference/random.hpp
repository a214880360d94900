// Philox4x32-10 in plain integers (Salmon, Moraes, Dror, Shaw 2011), written from the paper.
#pragma once
#include <array>
#include <cstdint>

namespace clvr::reference {

/// The block of four numbers for a counter and a key.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

} // namespace clvr::reference
