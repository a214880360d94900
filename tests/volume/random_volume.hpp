// Volumes and transfer tables made of seeded random numbers.
#pragma once
#include "host/appearance/transfer_function.hpp"

#include <cstring>
#include <limits>
#include <random>

namespace clvr::testing {

using Random = std::mt19937_64;

/// 0 <= u < 1.
inline double uniform(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }
inline int below(Random& random, int n) { return static_cast<int>(uniform(random) * n); }

inline const VoxelType all_types[] = {VoxelType::u8, VoxelType::i8, VoxelType::u16, VoxelType::i16, VoxelType::f32};

/// Every voxel drawn from low..high (the type's whole range by default; -1..1 for f32).
inline Voxels random_volume(Random& random, VoxelType type, const Int3& dims, double low = 1, double high = -1) {
    Voxels v;
    v.type = type;
    v.dims = dims;
    v.bytes.resize(v.count() * voxel_bytes(type));
    with_voxel_type(type, [&](auto sample) {
        using T = decltype(sample);
        const bool whole = low > high;
        const double l = !whole ? low : std::is_integral_v<T> ? static_cast<double>(std::numeric_limits<T>::lowest()) : -1;
        const double h = !whole ? high : std::is_integral_v<T> ? static_cast<double>(std::numeric_limits<T>::max()) : 1;
        for (std::size_t i = 0; i < v.count(); ++i) {
            const double value = l + uniform(random) * (h - l + (std::is_integral_v<T> ? 1 : 0));
            const T stored = static_cast<T>(std::is_integral_v<T> ? std::floor(value) : value);
            std::memcpy(v.bytes.data() + i * sizeof(T), &stored, sizeof(T));
        }
    });
    return v;
}

/// Random runs of zero, constant, rising and single-entry opacities between two stored values.
inline TransferTable random_table(Random& random, double first, double last) {
    TransferTable t;
    t.first = first;
    t.last = last;
    t.color.assign(4 * transfer_entries, 0.5f);
    while (t.opacity.size() < transfer_entries) {
        const int kind = below(random, 4), length = kind == 3 ? 1 : 1 + below(random, 1000);
        const double from = kind == 0 ? 0 : uniform(random), to = kind == 2 ? uniform(random) : from;
        for (int e = 0; e < length && t.opacity.size() < transfer_entries; ++e)
            t.opacity.push_back(static_cast<float>(from + (to - from) * e / length));
    }
    return t;
}

} // namespace clvr::testing
