// Drives the kernels of kernels/volume/: lists the parts that matter to each cell of voxels, launches, converts to the type asked for.
#include "host/phantom/phantom.hpp"
#include "host/phantom/parts.hpp"
#include "host/phantom/tunables.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace clvr {
namespace {

using namespace shared;

constexpr Int3 cell_voxels{CLVR_CELL_X, CLVR_CELL_Y, CLVR_CELL_Z};
constexpr int launch_voxels = 2 << 20; ///< about 0.1 s on two cores

/// The parts to look at for each cell of some slices of voxels.
struct PartLists {
    Buffer start, list;
};

/// The kernel decides for each voxel whether the part has an effect; here it only must not be missed.
PartLists list_parts(Device& device, const MadeVolume& made, const Int3& first_voxel, const Int3& cells, const Double3& spacing) {
    std::vector<std::vector<uint>> of(static_cast<std::size_t>(cells[0]) * cells[1] * cells[2] * made.bodies.size());
    uint part_index = 0;
    for (std::size_t body = 0; body < made.bodies.size(); ++body)
        for (const PhantomPart& part : made.bodies[body].parts) {
            const double reach = part.center.w + 2 * CLVR_PHANTOM_BEND;
            for (const double side : {1.0, -1.0}) {
                if (side < 0 && (!made.bodies[body].mirrored || part.center.x == 0)) continue;
                const Double3 center{side * part.center.x, part.center.y, part.center.z};
                Int3 low, high;
                for (int a = 0; a < 3; ++a) {
                    const double from_first = center[a] - made.box_low[a] - first_voxel[a] * spacing[a],
                                 cell_mm = cell_voxels[a] * spacing[a];
                    low[a] = std::max(static_cast<int>(std::floor((from_first - reach) / cell_mm)), 0);
                    high[a] = std::min(static_cast<int>(std::floor((from_first + reach) / cell_mm)), cells[a] - 1);
                }
                for (int z = low[2]; z <= high[2]; ++z)
                    for (int y = low[1]; y <= high[1]; ++y)
                        for (int x = low[0]; x <= high[0]; ++x) {
                            auto& parts = of[((static_cast<std::size_t>(z) * cells[1] + y) * cells[0] + x) * made.bodies.size() + body];
                            if (parts.empty() || parts.back() != part_index) parts.push_back(part_index);
                        }
            }
            ++part_index;
        }
    std::vector<uint> start{0}, list;
    for (const auto& parts : of) {
        list.insert(list.end(), parts.begin(), parts.end());
        start.push_back(static_cast<uint>(list.size()));
    }
    return {device.upload(start, "phantom lists"), device.upload(list, "phantom lists")};
}

/// Sets the scale in which the type holds -1024 .. 3071 HU.
void set_scale(Voxels& v) {
    v.slope = voxel_bytes(v.type) == 1 ? 16 : 1;
    v.intercept = v.type == VoxelType::u8 || v.type == VoxelType::u16 ? -1024 : v.type == VoxelType::i8 ? 1024 : 0;
}

/// Stores Hounsfield units from voxel `first` on, rounded down to the type's scale.
void store(const std::vector<std::int16_t>& hu, std::size_t first, Voxels& v) {
    with_voxel_type(v.type, [&](auto sample) {
        using T = decltype(sample);
        const int slope = static_cast<int>(v.slope), zero = (1024 + static_cast<int>(v.intercept)) / slope;
        T* to = reinterpret_cast<T*>(v.bytes.data()) + first;
        for (const int value : hu) *to++ = static_cast<T>((value + 1024) / slope - zero);
    });
}

/// The computed volumes by name, as phantom_names() lists them.
const std::vector<std::pair<std::string, MadeVolume (*)(std::uint64_t seed)>>& makers() {
    static const std::vector<std::pair<std::string, MadeVolume (*)(std::uint64_t)>> all{
        {"head", [](std::uint64_t) { return head_volume(true); }},
        {"head-closed", [](std::uint64_t) { return head_volume(false); }},
        {"beetle", beetle_volume},
        {"snake", snake_volume},
        {"vessels", vessel_volume},
        {"foam", [](std::uint64_t) { return foam_volume(); }},
        {"machine", machine_volume},
        {"skull", skull_volume},
        {"cloud", cloud_volume},
        {"rock", [](std::uint64_t) { return rock_volume(); }},
        {"fibres", fibres_volume}};
    return all;
}

MadeVolume volume_named(const std::string& name, std::uint64_t seed) {
    for (const auto& [known, make] : makers())
        if (known == name) return make(seed);
    throw Error(ErrorKind::usage, fmt::format("there is no such computed volume; there are: {}", fmt::join(phantom_names(), ", ")),
                "demo:" + name);
}

} // namespace

std::vector<std::string> phantom_names() {
    std::vector<std::string> names;
    for (const auto& maker : makers()) names.push_back(maker.first);
    return names;
}

PhantomSize phantom_size(const std::string& name) {
    const MadeVolume made = volume_named(name, 0);
    return {made.dims, made.type};
}

Voxels make_phantom(Device& device, const std::string& name, const PhantomOptions& options) {
    const MadeVolume made = volume_named(name, options.seed);
    const Int3 dims = options.dims.value_or(made.dims);
    const VoxelType type = options.type.value_or(made.type);
    if (*std::min_element(dims.begin(), dims.end()) < 1 || *std::max_element(dims.begin(), dims.end()) > 2048)
        throw Error(ErrorKind::usage, fmt::format("expected 1 to 2048 voxels along each axis, found {}", fmt::join(dims, "x")),
                    "demo:" + name);

    Voxels v;
    v.type = type;
    v.dims = dims;
    v.bytes.resize(v.count() * voxel_bytes(type));
    v.source = "demo:" + name;
    v.format = "computed";
    v.modality = "CT";
    set_scale(v);
    for (int a = 0; a < 3; ++a) {
        v.geometry.spacing[a] = made.box_size[a] / dims[a];
        v.geometry.origin[a] = made.box_low[a] + v.geometry.spacing[a] / 2;
    }

    const auto float4_of = [](const Double3& xyz, double w) {
        return float4{static_cast<float>(xyz[0]), static_cast<float>(xyz[1]), static_cast<float>(xyz[2]), static_cast<float>(w)};
    };
    const Double3& spacing = v.geometry.spacing;
    // Less than the distances that the bodies keep, else what lies beyond would be painted, too.
    double ramp_mm = std::min(1.6 * *std::max_element(spacing.begin(), spacing.end()), 4.0);
    for (const MadeBody& body : made.bodies) ramp_mm = std::min(ramp_mm, 2.0 * static_cast<double>(body.far));
    const auto cells_for = [](int voxels, int axis) { return (voxels + cell_voxels[axis] - 1) / cell_voxels[axis]; };
    PhantomParams params{};
    params.dims = {dims[0], dims[1], dims[2], 0};
    params.cells = {cells_for(dims[0], 0), cells_for(dims[1], 1), 0, 0};
    params.origin = float4_of(v.geometry.origin, 1 / ramp_mm);
    params.spacing = float4_of(spacing, 0);
    for (std::size_t k = 0; k < made.bodies.size(); ++k) params.far[k] = made.bodies[k].far;
    params.key0 = static_cast<uint>(options.seed);
    params.key1 = static_cast<uint>(options.seed >> 32) ^ 0x51ed270bu;
    params.opened = made.opened;

    std::vector<PhantomPart> all_parts;
    for (const auto& body : made.bodies) all_parts.insert(all_parts.end(), body.parts.begin(), body.parts.end());
    const Buffer params_buffer = device.upload(std::vector<PhantomParams>{params}, "phantom parameters");
    const Buffer parts = device.upload(all_parts, "phantom parts");

    const std::size_t slice_voxels = static_cast<std::size_t>(dims[0]) * dims[1];
    const int launch_cells = std::max(1, static_cast<int>(launch_voxels / slice_voxels / CLVR_CELL_Z)),
              launch_slices = launch_cells * CLVR_CELL_Z;
    const Buffer out = device.buffer(slice_voxels * std::min(launch_slices, dims[2]) * sizeof(std::int16_t), "phantom");
    const int width = device.tunable(tunables::packet);
    Kernel kernel = device.kernel("volume/" + made.kernel, {{"CLVR_WIDTH", std::to_string(width)}});
    const Range group = kernel.group(static_cast<std::size_t>(device.tunable(tunables::phantom_group)));
    for (int z = 0; z < dims[2]; z += launch_slices) {
        if (options.cancelled && *options.cancelled)
            throw Error(ErrorKind::interrupted, "interrupted while the volume was computed", v.source);
        const int slices = std::min(launch_slices, dims[2] - z);
        const PartLists lists = list_parts(device, made, {0, 0, z}, {params.cells.x, params.cells.y, cells_for(slices, 2)}, spacing);
        const Range packets{static_cast<std::size_t>((dims[0] + width - 1) / width), static_cast<std::size_t>(dims[1]),
                            static_cast<std::size_t>(slices)};
        const Work work{static_cast<double>(slice_voxels * slices * sizeof(std::int16_t)), 0};
        device.launch(kernel, packets, group, work, out, params_buffer, parts, lists.start, lists.list, z, slices);
        store(device.download<std::int16_t>(out, slice_voxels * slices), slice_voxels * z, v);
    }
    return v;
}

} // namespace clvr
