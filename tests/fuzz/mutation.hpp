// Small damage to bytes, the same for a seed on every machine.
#pragma once
#include <random>
#include <string>

namespace clvr::test {

/// Changes `bytes` in one to four places: flipped bits, other bytes, numbers at the edges of their types (binary, either order, or text),
/// pieces taken out, doubled or taken from `other`.
std::string mutated(std::string bytes, const std::string& other, std::mt19937_64& random);

} // namespace clvr::test
