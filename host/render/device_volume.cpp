#include "host/render/device_volume.hpp"
#include "host/render/tunables.hpp"

#include <algorithm>
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

constexpr std::size_t upload_piece = std::size_t{4} << 20; // [bytes]: the host never holds a second copy of the volume

} // namespace

int packet_width(const Device& device) { return device.tunable(tunables::packet); }

std::size_t packet_group(const Device& device) { return static_cast<std::size_t>(device.tunable(tunables::packet_group)); }

BrickLayout device_layout(const Device& device, const Classified& c) {
    constexpr int usual = 5;
    const int by_dims = brick_log2_edge(c.voxels->dims), log2_edge = by_dims == usual ? device.tunable(tunables::brick_log2) : by_dims;
    const std::size_t most = device.max_alloc_bytes();
    // The apron at edge 32 adds at most 31 %; thin volumes are kept to what is visible.
    const double all = 1.31 * static_cast<double>(c.voxels->count()) * static_cast<double>(voxel_bytes(c.voxels->type));
    if (by_dims == usual && all <= static_cast<double>(std::min(most, device.free_bytes() / 2))) {
        BrickLayout layout = brick_layout(*c.voxels, *c.grid, std::vector<float>(c.grid->count(), 1), log2_edge, most);
        if (layout.pools == 1) return layout;
    }
    return brick_layout(*c.voxels, *c.grid, c.majorants, log2_edge, most);
}

DeviceBricks::DeviceBricks(Device& device, const Classified& c, const BrickLayout& layout)
    : layout_(layout), present_(layout.offset.size(), 0), offset_(device.upload(layout.offset, "brick offsets")),
      pool_(device.upload(layout.pool, "brick pools")) {
    for (const std::size_t bytes : layout.pool_bytes) voxels_.push_back(device.buffer(std::max<std::size_t>(bytes, 16), "bricks"));
    const VoxelType type = c.voxels->type;
    defines_ = {{"CLVR_VOXEL", opencl_type(type)},
                {"CLVR_VOXEL_BITS", std::to_string(8 * voxel_bytes(type))},
                {"CLVR_VOXEL_SIGNED", type == VoxelType::i8 || type == VoxelType::i16 ? "1" : "0"},
                {"CLVR_POOLS", std::to_string(layout.pools)}};
    if (!show(device, c)) throw Error(ErrorKind::internal, "a layout of bricks lacks one that is visible", "DeviceBricks");
}

bool DeviceBricks::show(Device& device, const Classified& c) {
    const std::vector<char> needed = needed_bricks(*c.grid, c.majorants, layout_);
    std::vector<std::vector<std::size_t>> missing(voxels_.size()); // by pool
    for (std::size_t b = 0; b < needed.size(); ++b) {
        if (!needed[b] || present_[b]) continue;
        if (layout_.offset[b] == BrickLayout::absent) return false;
        missing[layout_.pool[b]].push_back(b);
    }
    for (std::size_t k = 0; k < missing.size(); ++k) {
        pack_bricks(*c.voxels, layout_, missing[k], upload_piece, [&](const unsigned char* bytes, std::size_t size, std::size_t offset) {
            device.write(voxels_[k], bytes, size, offset);
        });
        for (const std::size_t b : missing[k]) present_[b] = 1;
    }
    return true;
}

void DeviceBricks::append_to(BufferList& list) const {
    list.push_back(&offset_);
    list.push_back(&pool_);
    for (const Buffer& b : voxels_) list.push_back(&b);
}

DeviceAppearance::DeviceAppearance(Device& device, const Classified& c, const shared::VolumeParams& params, const DeviceBricks& bricks)
    : host_params_(params), params_(device.upload(std::vector<shared::VolumeParams>{params}, "volume parameters")),
      majorants_(device.upload(c.majorants, "majorants")), opacity_(device.upload(c.table.opacity, "opacity table")),
      color_(device.upload(c.table.color, "colour table")) {
    std::vector<std::uint32_t> visible(c.table.opacity.size() + 1, 0);
    for (std::size_t e = 0; e < c.table.opacity.size(); ++e) visible[e + 1] = visible[e] + (c.table.opacity[e] > 0 ? 1 : 0);
    const Buffer visible_before = device.upload(visible, "visible table entries");
    const Range cells{static_cast<std::size_t>(params.coarse.x), static_cast<std::size_t>(params.coarse.y),
                      static_cast<std::size_t>(params.coarse.z)};
    coarse_ = device.buffer(cells.x * cells.y * cells.z * sizeof(float), "coarse opacity");
    Kernel kernel = device.kernel("volume/coarse_opacity", bricks.defines());
    BufferList volume;
    append_to(volume);
    bricks.append_to(volume);
    device.launch(kernel, cells, kernel.group(static_cast<std::size_t>(device.tunable(tunables::shade_group))), {}, volume, visible_before,
                  coarse_);
    // The greatest of the distances along the axes is found one axis after the other.
    Buffer other = device.buffer(coarse_.bytes(), "coarse opacity");
    const int width = packet_width(device);
    Kernel distances = device.kernel("volume/distances", {{"CLVR_WIDTH", std::to_string(width)}});
    const Range packets{(cells.x + static_cast<std::size_t>(width) - 1) / static_cast<std::size_t>(width), cells.y, cells.z};
    const float farthest = static_cast<float>(std::max({params.coarse.x, params.coarse.y, params.coarse.z}) + 1);
    for (cl_int axis = 0; axis < 3; ++axis) {
        device.launch(distances, packets, distances.group(packet_group(device)), {}, coarse_, params.coarse, axis, farthest, other);
        std::swap(coarse_, other);
    }
    device.finish(); // before `other` goes
}

void DeviceAppearance::append_to(BufferList& list) const {
    for (const Buffer* b : {&params_, &majorants_, &opacity_, &color_}) list.push_back(b);
}

bool DeviceVolume::set_appearance(Device& device, const Classified& c, const shared::VolumeParams& params) {
    if (!bricks_.show(device, c)) return false;
    appearance_ = DeviceAppearance(device, c, params, bricks_);
    return true;
}

BufferList DeviceVolume::arguments() const {
    BufferList list;
    appearance_.append_to(list);
    bricks_.append_to(list);
    return list;
}

} // namespace clvr
