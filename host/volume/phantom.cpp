// Drives kernels/volume/phantom.cl: lists the parts that matter to each cell of voxels, launches, converts to the type asked for.
#include "host/volume/phantom.hpp"
#include "host/volume/phantom_anatomy.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace clvr {
namespace {

using namespace shared;

constexpr Double3 box_low{-96.8, -127, -122}, box_size{193.6, 242, 255.2}; ///< [mm]
constexpr double bend = 2;                                                 ///< the kernel displaces points by at most this [mm]
constexpr Int3 cell_voxels{CLVR_CELL_X, CLVR_CELL_Y, CLVR_CELL_Z};

struct PartLists {
    std::vector<PhantomPart> parts;
    std::vector<uint> start, list;
};

PartLists list_parts(const Anatomy& anatomy, const Int3& cells, const Double3& spacing) {
    PartLists lists;
    std::vector<std::vector<uint>> of(static_cast<std::size_t>(cells[0]) * cells[1] * cells[2] * CLVR_BODIES);
    for (int body = 0; body < CLVR_BODIES; ++body)
        for (const PhantomPart& part : anatomy[body]) {
            const uint index = static_cast<uint>(lists.parts.size());
            lists.parts.push_back(part);
            const Double3 center{part.center.x, part.center.y, part.center.z};
            const double reach = part.center.w + bend;
            // A mirrored part acts on both sides; its mirror image is listed by the same test with x negated.
            for (const double side : {1.0, -1.0}) {
                if (side < 0 && body == CLVR_VESSELS) continue;
                Int3 low, high;
                for (int a = 0; a < 3; ++a) {
                    const double c = (a == 0 ? side : 1) * center[a] - box_low[a], size = cell_voxels[a] * spacing[a];
                    low[a] = std::max(static_cast<int>(std::floor((c - reach) / size)), 0);
                    high[a] = std::min(static_cast<int>(std::floor((c + reach) / size)), cells[a] - 1);
                }
                for (int z = low[2]; z <= high[2]; ++z)
                    for (int y = low[1]; y <= high[1]; ++y)
                        for (int x = low[0]; x <= high[0]; ++x) {
                            auto& entries = of[((static_cast<std::size_t>(z) * cells[1] + y) * cells[0] + x) * CLVR_BODIES + body];
                            if (entries.empty() || entries.back() != index) entries.push_back(index);
                        }
            }
        }
    for (const auto& entries : of) {
        lists.start.push_back(static_cast<uint>(lists.list.size()));
        lists.list.insert(lists.list.end(), entries.begin(), entries.end());
    }
    lists.start.push_back(static_cast<uint>(lists.list.size()));
    return lists;
}

/// Hounsfield units as the stored type's own scale.
void convert(const std::vector<std::int16_t>& hu, Voxels& v) {
    v.bytes.resize(hu.size() * voxel_bytes(v.type));
    const bool byte = voxel_bytes(v.type) == 1;
    v.slope = byte ? 16 : 1;
    v.intercept = v.type == VoxelType::u8 || v.type == VoxelType::u16 ? -1024 : v.type == VoxelType::i8 ? 1024 : 0;
    with_voxel_type(v.type, [&](auto sample) {
        using T = decltype(sample);
        const int divisor = static_cast<int>(v.slope), offset = static_cast<int>(v.intercept);
        for (std::size_t i = 0; i < hu.size(); ++i) {
            const int shifted = hu[i] + 1024; // 0 .. 4095, so that the division rounds down
            const T stored = static_cast<T>(shifted / divisor - (1024 + offset) / divisor);
            std::memcpy(v.bytes.data() + i * sizeof(T), &stored, sizeof(T));
        }
    });
}

} // namespace

Voxels make_phantom(Device& device, const std::string& name, const Int3& dims, VoxelType type, std::uint64_t seed) {
    if (name != "head")
        throw Error(ErrorKind::usage, fmt::format("there is no computed volume '{}'; there is: head", name), "demo:" + name);
    for (const int n : dims)
        if (n < 1 || n > 4096)
            throw Error(ErrorKind::usage, fmt::format("dims must be 1 to 4096, found {}x{}x{}", dims[0], dims[1], dims[2]), "demo:" + name);

    Voxels v;
    v.type = type;
    v.dims = dims;
    v.source = "demo:" + name;
    v.format = "computed";
    v.modality = "CT";
    for (int a = 0; a < 3; ++a) {
        v.geometry.spacing[a] = box_size[a] / dims[a];
        v.geometry.origin[a] = box_low[a] + v.geometry.spacing[a] / 2;
    }
    const Double3 &spacing = v.geometry.spacing, &origin = v.geometry.origin;
    const auto rounded = [](double x) { return static_cast<float>(x); };

    PhantomParams params{};
    Int3 cells;
    for (int a = 0; a < 3; ++a) cells[a] = (dims[a] + cell_voxels[a] - 1) / cell_voxels[a];
    const double ramp_mm = std::min(1.6 * std::max({spacing[0], spacing[1], spacing[2]}), 4.0);
    params.dims = {dims[0], dims[1], dims[2], 0};
    params.cells = {cells[0], cells[1], cells[2], 0};
    params.origin = {rounded(origin[0]), rounded(origin[1]), rounded(origin[2]), rounded(1 / ramp_mm)};
    params.spacing = {rounded(spacing[0]), rounded(spacing[1]), rounded(spacing[2]), 0};
    std::copy(body_far.begin(), body_far.end(), params.far);
    params.key0 = static_cast<uint>(seed);
    params.key1 = static_cast<uint>(seed >> 32) ^ 0x51ed270bu;

    const PartLists lists = list_parts(head_anatomy(), cells, spacing);
    const Buffer params_buffer = device.upload(std::vector<PhantomParams>{params}, "phantom parameters");
    const Buffer parts = device.upload(lists.parts, "phantom parts"), start = device.upload(lists.start, "phantom lists");
    const Buffer list = device.upload(lists.list, "phantom lists");
    const Buffer out = device.buffer(v.count() * sizeof(std::int16_t), "phantom");
    const int width = device.tunable("packet_width", device.facts().type == DeviceType::cpu ? 16 : 1);
    Kernel kernel = device.kernel("volume/phantom", {{"CLVR_WIDTH", std::to_string(width)}});
    const Range packets{static_cast<std::size_t>((dims[0] + width - 1) / width), static_cast<std::size_t>(dims[1]),
                        static_cast<std::size_t>(dims[2])};
    device.launch(kernel, packets, Range{1, 8, 1}, Work{v.count() * 2.0, 0}, out, params_buffer, parts, start, list);
    convert(device.download<std::int16_t>(out, v.count()), v);
    return v;
}

} // namespace clvr
