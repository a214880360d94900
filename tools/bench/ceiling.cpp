#include "tools/bench/ceiling.hpp"

#include <algorithm>
#include <cstring>
#include <immintrin.h>
#include <new>
#include <thread>

namespace clvr::native {
namespace {

// Each of the three loops of an instruction set: LANES floats a register, CHAINS that fit the registers and cover latency x units.
#define CLVR_LOOPS(NAME, TARGET, VECTOR, LANES, CHAINS, SET, FMA, LOAD, STREAM)                                                            \
    __attribute__((target(TARGET))) double NAME##_fma(long rounds, float* out) {                                                           \
        const VECTOR a = SET(0.999999f), b = SET(1e-7f);                                                                                   \
        VECTOR v[CHAINS];                                                                                                                  \
        for (int c = 0; c < CHAINS; ++c) v[c] = SET(static_cast<float>(c));                                                                \
        for (long r = 0; r < rounds; ++r) _Pragma("GCC unroll 16") for (int c = 0; c < CHAINS; ++c) v[c] = FMA(v[c], a, b);                \
        for (int c = 0; c < CHAINS; ++c) {                                                                                                 \
            float lanes[LANES];                                                                                                            \
            std::memcpy(lanes, &v[c], sizeof lanes);                                                                                       \
            *out += lanes[c % LANES];                                                                                                      \
        }                                                                                                                                  \
        return 2.0 * LANES * CHAINS * static_cast<double>(rounds);                                                                         \
    }                                                                                                                                      \
    __attribute__((target(TARGET))) void NAME##_copy(const float* from, float* to, std::size_t count) {                                    \
        std::size_t i = 0;                                                                                                                 \
        for (; i + LANES <= count; i += LANES) STREAM(to + i, LOAD(from + i));                                                             \
        for (; i < count; ++i) to[i] = from[i];                                                                                            \
        _mm_sfence();                                                                                                                      \
    }                                                                                                                                      \
    __attribute__((target(TARGET))) void NAME##_triad(const float* a, const float* b, float* to, float s, std::size_t count) {             \
        const VECTOR scale = SET(s);                                                                                                       \
        std::size_t i = 0;                                                                                                                 \
        for (; i + LANES <= count; i += LANES) STREAM(to + i, FMA(scale, LOAD(b + i), LOAD(a + i)));                                       \
        for (; i < count; ++i) to[i] = a[i] + s * b[i];                                                                                    \
        _mm_sfence();                                                                                                                      \
    }
#define CLVR_SSE_FMA(x, y, z) _mm_add_ps(_mm_mul_ps(x, y), z)
CLVR_LOOPS(avx512, "avx512f", __m512, 16, 16, _mm512_set1_ps, _mm512_fmadd_ps, _mm512_load_ps, _mm512_stream_ps)
CLVR_LOOPS(avx2, "avx2,fma", __m256, 8, 12, _mm256_set1_ps, _mm256_fmadd_ps, _mm256_load_ps, _mm256_stream_ps)
CLVR_LOOPS(sse, "sse2", __m128, 4, 12, _mm_set1_ps, CLVR_SSE_FMA, _mm_load_ps, _mm_stream_ps)
#undef CLVR_LOOPS

struct Loops {
    double (*fma)(long, float*);
    void (*copy)(const float*, float*, std::size_t);
    void (*triad)(const float*, const float*, float*, float, std::size_t);
};

const Loops& loops() {
    static const Loops chosen = __builtin_cpu_supports("avx512f") ? Loops{avx512_fma, avx512_copy, avx512_triad}
                                : __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? Loops{avx2_fma, avx2_copy, avx2_triad}
                                                                                                  : Loops{sse_fma, sse_copy, sse_triad};
    return chosen;
}

/// Calls f(thread) on so many threads, the caller's among them.
template <class F>
void on_threads(unsigned threads, F&& f) {
    std::vector<std::thread> others;
    for (unsigned t = 1; t < threads; ++t) others.emplace_back([&f, t] { f(t); });
    f(0u);
    for (std::thread& t : others) t.join();
}

/// Calls f(first, count) for equal parts, each at a multiple of 16.
template <class F>
void in_parts(std::size_t count, unsigned threads, F&& f) {
    const std::size_t part = (count / threads + 16) / 16 * 16;
    on_threads(threads, [&](unsigned t) {
        const std::size_t first = std::min(count, part * t);
        f(first, std::min(part, count - first));
    });
}

} // namespace

double fma_chains(long rounds, unsigned threads) {
    struct alignas(64) Sum { // a cache line each
        float value = 0;
        double operations = 0;
    };
    std::vector<Sum> sums(threads);
    on_threads(threads, [&](unsigned t) { sums[t].operations = loops().fma(rounds, &sums[t].value); });
    double operations = 0;
    volatile float keep = 0;
    for (const Sum& s : sums) operations += s.operations, keep = keep + s.value;
    return operations;
}

double copy(const float* from, float* to, std::size_t count, unsigned threads) {
    in_parts(count, threads, [&](std::size_t first, std::size_t n) { loops().copy(from + first, to + first, n); });
    return 8.0 * static_cast<double>(count);
}

double triad(const float* a, const float* b, float* to, float s, std::size_t count, unsigned threads) {
    in_parts(count, threads, [&](std::size_t first, std::size_t n) { loops().triad(a + first, b + first, to + first, s, n); });
    return 12.0 * static_cast<double>(count);
}

AlignedFloats::AlignedFloats(std::size_t count)
    : data_(static_cast<float*>(::operator new (std::max<std::size_t>(count, 1) * sizeof(float), std::align_val_t{64}))), count_(count) {
    std::fill_n(data_, count, 0.0f);
}
AlignedFloats::~AlignedFloats() { ::operator delete (data_, std::align_val_t{64}); }

} // namespace clvr::native
