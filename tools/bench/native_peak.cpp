#include "tools/bench/native_peak.hpp"

#include <thread>

namespace clvr::native {

namespace {

constexpr int lanes = 16, chains = 16;
typedef float Vector __attribute__((vector_size(lanes * sizeof(float))));

void run(long rounds, float* out) {
    Vector v[chains], a, b;
    for (int l = 0; l < lanes; ++l) a[l] = 0.999999f, b[l] = 1e-7f * static_cast<float>(l);
    for (int c = 0; c < chains; ++c) v[c] = b * static_cast<float>(c);
    for (long r = 0; r < rounds; ++r)
#pragma GCC unroll 16
        for (int c = 0; c < chains; ++c) v[c] = v[c] * a + b; // contracted: this file is built with -ffp-contract=fast
    for (int c = 0; c < chains; ++c) *out += v[c][c % lanes];
}

} // namespace

double fma_chains(long rounds) {
    float sums[2] = {0, 0};
    std::thread other(run, rounds, &sums[1]);
    run(rounds, &sums[0]);
    other.join();
    volatile float keep = sums[0] + sums[1];
    static_cast<void>(keep);
    return 2.0 * 2 * lanes * chains * static_cast<double>(rounds);
}

} // namespace clvr::native
