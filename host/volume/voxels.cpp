#include "host/volume/voxels.hpp"
#include "host/volume/stored_counts.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <type_traits>

namespace clvr {

constexpr std::size_t histogram_bins = 1024;

const char* voxel_type_name(VoxelType t) {
    switch (t) {
    case VoxelType::u8:
        return "u8";
    case VoxelType::i8:
        return "i8";
    case VoxelType::u16:
        return "u16";
    case VoxelType::i16:
        return "i16";
    case VoxelType::f32:
        return "f32";
    }
    throw std::logic_error("voxel type");
}

std::optional<VoxelType> voxel_type_named(const std::string& name) {
    for (const VoxelType t : {VoxelType::u8, VoxelType::i8, VoxelType::u16, VoxelType::i16, VoxelType::f32})
        if (name == voxel_type_name(t)) return t;
    return std::nullopt;
}

namespace {

/// Where a value falls between low and high.
struct Binning {
    double low, scale;
    Binning(double low_value, double high_value)
        : low(low_value), scale(high_value > low_value ? histogram_bins / (high_value - low_value) : 0.0) {}
    std::size_t operator()(double value) const { return std::min(static_cast<std::size_t>((value - low) * scale), histogram_bins - 1); }
};

std::size_t slices_of(const Voxels& v) { return static_cast<std::size_t>(v.dims[2]); }

template <class T>
void count_values(const Voxels& v, Histogram& h) {
    constexpr int least = std::numeric_limits<T>::min(), greatest = std::numeric_limits<T>::max();
    h.stored = stored_counts(v);
    const std::vector<std::uint64_t>& counts = h.stored.all;
    const auto used = [](std::uint64_t n) { return n > 0; };
    h.low = least + (std::find_if(counts.begin(), counts.end(), used) - counts.begin());
    h.high = greatest - (std::find_if(counts.rbegin(), counts.rend(), used) - counts.rbegin());
    const Binning bin(h.low, h.high);
    for (int value = static_cast<int>(h.low); value <= static_cast<int>(h.high); ++value) h.bins[bin(value)] += counts[value - least];
}

/// Range first, bins second.
void count_floats(const Voxels& v, Histogram& h) {
    const float* const voxels = v.data<float>();
    const std::size_t slab = static_cast<std::size_t>(v.dims[0]) * v.dims[1];
    std::mutex merging;
    float low = voxels[0], high = voxels[0];
    for_parts(slices_of(v), [&](std::size_t, std::size_t first, std::size_t last) {
        const auto [least, greatest] = std::minmax_element(voxels + first * slab, voxels + last * slab);
        const std::lock_guard lock(merging);
        low = std::min(low, *least);
        high = std::max(high, *greatest);
    });
    h.low = low;
    h.high = high;
    const Binning bin(h.low, h.high);
    for_parts(slices_of(v), [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<std::uint64_t> part(histogram_bins);
        for (const float *p = voxels + first * slab, *const end = voxels + last * slab; p != end; ++p) ++part[bin(double{*p})];
        const std::lock_guard lock(merging);
        for (std::size_t b = 0; b < histogram_bins; ++b) h.bins[b] += part[b];
    });
}

} // namespace

Histogram stored_histogram(const Voxels& v) {
    Histogram h;
    h.bins.assign(histogram_bins, 0);
    if (v.count() == 0) return h;
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_integral_v<T>)
            count_values<T>(v, h);
        else
            count_floats(v, h);
    });
    return h;
}

} // namespace clvr
