// The processor's own ceilings, by native code: what a kernel on it can be held against. Made for the best of AVX-512, AVX2 and SSE that
// the processor has, chosen at run time.
#pragma once
#include <cstddef>
#include <vector>

namespace clvr::native {

/// Runs `rounds` of independent chains of vector FMAs on so many threads (the caller's is one); the floating-point operations done.
double fma_chains(long rounds, unsigned threads);

/// Copies `count` floats, and to = a + s b, on so many threads, each with an equal part; stores that bypass the caches. Arrays begin at
/// 64-byte borders. The bytes that the program asked to move (2 and 3 arrays).
double copy(const float* from, float* to, std::size_t count, unsigned threads);
double triad(const float* a, const float* b, float* to, float s, std::size_t count, unsigned threads);

/// Floats that begin at a 64-byte border, all 0 at first.
class AlignedFloats {
public:
    explicit AlignedFloats(std::size_t count);
    ~AlignedFloats();
    AlignedFloats(const AlignedFloats&) = delete;
    AlignedFloats& operator=(const AlignedFloats&) = delete;
    float* data() { return data_; }
    std::size_t size() const { return count_; }

private:
    float* data_;
    std::size_t count_;
};

} // namespace clvr::native
