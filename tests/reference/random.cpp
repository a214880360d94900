#include "tests/reference/random.hpp"

namespace clvr::reference {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t left = 0xD2511F53ull * counter[0], right = 0xCD9E8D57ull * counter[2];
        const auto high = [](std::uint64_t product) { return static_cast<std::uint32_t>(product >> 32); };
        const auto low = [](std::uint64_t product) { return static_cast<std::uint32_t>(product); };
        counter = {high(right) ^ counter[1] ^ key[0], low(right), high(left) ^ counter[3] ^ key[1], low(left)};
        key[0] += 0x9E3779B9u; // the golden ratio
        key[1] += 0xBB67AE85u; // sqrt(3) - 1
    }
    return counter;
}

namespace {

std::uint32_t reversed(std::uint32_t x) {
    std::uint32_t r = 0;
    for (int k = 0; k < 32; ++k) r |= (x >> k & 1u) << (31 - k);
    return r;
}

/// The hash of Laine and Karras: each digit, from the most significant one on, depends on those before it alone.
std::uint32_t owen(std::uint32_t fraction, std::uint32_t seed) {
    std::uint32_t x = reversed(fraction) + seed;
    for (std::uint32_t factor : {0x6c50b47cu, 0xb82f1e52u, 0xc7afe638u, 0x8d22f6e6u}) x ^= x * factor;
    return reversed(x);
}

std::uint32_t mixed(std::uint32_t x) {
    x ^= x >> 16, x *= 0x7feb352du;
    x ^= x >> 15, x *= 0x846ca68bu;
    return x ^ x >> 16;
}

std::uint32_t rotated(std::uint32_t x, int left) { return x << left | x >> (32 - left); }

} // namespace

std::array<std::uint32_t, 2> sobol(std::uint32_t pixel, std::uint32_t sample, std::uint32_t purpose, std::array<std::uint32_t, 2> key) {
    const std::uint32_t seed = mixed(mixed(mixed(pixel ^ key[0]) ^ key[1]) + purpose), index = owen(sample, seed);
    std::uint32_t x = 0, y = 0, direction = 1u << 31; // direction numbers of the polynomials 1 and 1 + x
    for (int bit = 0; bit < 32; ++bit, direction ^= direction >> 1)
        if (index >> bit & 1u) x ^= 1u << (31 - bit), y ^= direction;
    return {owen(x, rotated(seed, 11)), owen(y, rotated(seed, 22))};
}

} // namespace clvr::reference
