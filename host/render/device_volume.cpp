#include "host/render/device_volume.hpp"
#include "host/render/coarse_opacity.hpp"

#include <string>

namespace clvr {

namespace {

const char* opencl_type(VoxelType t) {
    switch (t) {
    case VoxelType::u8:
        return "uchar";
    case VoxelType::i8:
        return "char";
    case VoxelType::u16:
        return "ushort";
    case VoxelType::i16:
        return "short";
    case VoxelType::f32:
        return "float";
    }
    return "uchar";
}

[[noreturn]] void refuse_tunable(const std::string& name, int value, const std::string& expected) {
    throw Error(ErrorKind::usage, "is " + std::to_string(value) + "; expected " + expected, "tunable " + name);
}

constexpr std::size_t upload_piece = std::size_t{4} << 20; // [bytes]: the host never holds a second copy of the volume

} // namespace

int packet_width(const Device& device) {
    const DeviceFacts& f = device.facts();
    const int fallback = f.type != DeviceType::cpu || f.simulator ? 1 : f.native_float_width >= 16 ? 16 : f.native_float_width >= 8 ? 8 : 4;
    const int width = device.tunable("packet", fallback);
    if (width != 1 && width != 4 && width != 8 && width != 16) refuse_tunable("packet", width, "1, 4, 8 or 16");
    return width;
}

std::size_t packet_group(const Device& device, int width) {
    return static_cast<std::size_t>(device.tunable("packet_group", width > 1 || device.facts().simulator ? 1 : 64));
}

BrickLayout device_layout(const Device& device, const Classified& c) {
    constexpr int usual = 5;
    const int by_dims = brick_log2_edge(c.voxels->dims), log2_edge = by_dims == usual ? device.tunable("brick_log2", usual) : by_dims;
    if (log2_edge < 2 || log2_edge > 8) refuse_tunable("brick_log2", log2_edge, "2 to 8");
    return brick_layout(*c.voxels, *c.grid, c.majorants, log2_edge, device.max_alloc_bytes());
}

DeviceVolume::DeviceVolume(Device& device, const Classified& c, const BrickLayout& layout, const shared::VolumeParams& params)
    : host_params_(params) {
    params_ = device.upload(std::vector<shared::VolumeParams>{params}, "volume parameters");
    majorants_ = device.upload(c.majorants, "majorants");
    opacity_ = device.upload(c.table.opacity, "opacity table");
    color_ = device.upload(c.table.color, "colour table");
    offset_ = device.upload(layout.offset, "brick offsets");
    pool_ = device.upload(layout.pool, "brick pools");
    for (int k = 0; k < layout.pools; ++k) {
        voxels_.push_back(device.buffer(std::max<std::size_t>(layout.pool_bytes[k], 16), "bricks"));
        pack_pool(*c.voxels, layout, k, upload_piece,
                  [&](const unsigned char* bytes, std::size_t size, std::size_t offset) { device.write(voxels_[k], bytes, size, offset); });
    }
    const VoxelType type = c.voxels->type;
    defines_ = {{"CLVR_VOXEL", opencl_type(type)},
                {"CLVR_VOXEL_BITS", std::to_string(8 * voxel_bytes(type))},
                {"CLVR_VOXEL_SIGNED", type == VoxelType::i8 || type == VoxelType::i16 ? "1" : "0"},
                {"CLVR_POOLS", std::to_string(layout.pools)}};

    std::vector<std::uint32_t> visible(c.table.opacity.size() + 1, 0);
    for (std::size_t e = 0; e < c.table.opacity.size(); ++e) visible[e + 1] = visible[e] + (c.table.opacity[e] > 0 ? 1 : 0);
    const Buffer visible_before = device.upload(visible, "visible table entries");
    const Range cells{static_cast<std::size_t>(params.coarse.x), static_cast<std::size_t>(params.coarse.y),
                      static_cast<std::size_t>(params.coarse.z)};
    coarse_ = device.buffer(cells.x * cells.y * cells.z * sizeof(float), "coarse opacity");
    Kernel kernel = device.kernel("volume/coarse_opacity", defines_);
    device.launch(kernel, cells, kernel.group(packet_group(device, 1)), {}, arguments(), visible_before, coarse_);
    std::vector<float> mean = device.download<float>(coarse_, cells.x * cells.y * cells.z);
    mark_distances(mean, params.coarse);
    device.write(coarse_, mean.data(), mean.size() * sizeof(float));
}

BufferList DeviceVolume::arguments() const {
    BufferList list{&params_, &majorants_, &opacity_, &color_, &offset_, &pool_};
    for (const Buffer& b : voxels_) list.push_back(&b);
    return list;
}

} // namespace clvr
