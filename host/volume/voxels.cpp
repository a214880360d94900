#include "host/volume/voxels.hpp"
#include "host/volume/slabs.hpp"

#include <algorithm>
#include <mutex>

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

Histogram stored_histogram(const Voxels& v) {
    Histogram h;
    h.bins.assign(histogram_bins, 0);
    if (v.count() == 0) return h;
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        const T* const voxels = v.data<T>();
        const std::size_t slab = static_cast<std::size_t>(v.dims[0]) * v.dims[1];
        std::mutex merging;
        T low = voxels[0], high = voxels[0];
        for_slabs(v.dims[2], [&](int first, int last) {
            const auto [least, greatest] = std::minmax_element(voxels + first * slab, voxels + last * slab);
            const std::lock_guard lock(merging);
            low = std::min(low, *least);
            high = std::max(high, *greatest);
        });
        h.low = static_cast<double>(low);
        h.high = static_cast<double>(high);
        const double scale = h.high > h.low ? histogram_bins / (h.high - h.low) : 0.0;
        for_slabs(v.dims[2], [&](int first, int last) {
            std::vector<std::uint64_t> counts(histogram_bins);
            for (const T *p = voxels + first * slab, *const end = voxels + last * slab; p != end; ++p)
                ++counts[std::min(static_cast<std::size_t>((static_cast<double>(*p) - h.low) * scale), histogram_bins - 1)];
            const std::lock_guard lock(merging);
            for (std::size_t b = 0; b < histogram_bins; ++b) h.bins[b] += counts[b];
        });
    });
    return h;
}

} // namespace clvr
