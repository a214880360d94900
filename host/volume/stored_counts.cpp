#include "host/volume/stored_counts.hpp"
#include "runtime/system/parallel.hpp"

#include <limits>
#include <mutex>
#include <type_traits>

namespace clvr {

namespace {

/// Adds a run to `lanes` tables that stand behind each other. In one table, equal values in a row would wait for one another: with four of
/// bytes a run of one value takes a third of the time.
template <class T, std::size_t lanes>
void count_run(const T* values, std::size_t n, std::uint64_t* tables) {
    constexpr int least = std::numeric_limits<T>::min();
    constexpr std::size_t size = std::size_t{1} << 8 * sizeof(T);
    std::size_t i = 0;
    for (; i + lanes <= n; i += lanes)
        for (std::size_t k = 0; k < lanes; ++k) ++tables[k * size + static_cast<std::size_t>(values[i + k] - least)];
    for (; i < n; ++i) ++tables[values[i] - least];
}

template <class T>
StoredCounts count(const Voxels& v) {
    constexpr std::size_t size = std::size_t{1} << 8 * sizeof(T), lanes = sizeof(T) == 1 ? 4 : 2;
    StoredCounts counts{std::vector<std::uint64_t>(size), std::vector<std::uint64_t>(size)};
    std::mutex merging;
    for_parts(static_cast<std::size_t>(v.dims[2]), [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<std::uint64_t> inside(lanes * size), border(lanes * size);
        for_each_run<T>(v, first, last, [&](const T* values, std::size_t n, bool is_border) {
            count_run<T, lanes>(values, n, (is_border ? border : inside).data());
        });
        const std::lock_guard lock(merging);
        for (std::size_t i = 0; i < lanes * size; ++i) {
            counts.all[i % size] += inside[i] + border[i];
            counts.border[i % size] += border[i];
        }
    });
    return counts;
}

} // namespace

StoredCounts stored_counts(const Voxels& v) {
    return with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_integral_v<T>)
            return count<T>(v);
        else
            return StoredCounts{};
    });
}

} // namespace clvr
