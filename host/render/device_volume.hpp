// A volume and its classification on one device: the arguments VOLUME_ARGS of the kernels.
#pragma once
#include "host/render/classified.hpp"
#include "host/volume/brick_layout.hpp"
#include "kernels/shared/volume_params.h"
#include "runtime/opencl/device.hpp"

namespace clvr {

/// Where the bricks of a classified volume go on a device: room for all of them where one buffer holds it and that is at most half of what
/// is left of the device's memory, so that another transfer function uploads only what it shows more; else room for the visible ones.
/// Brick edge: tunable "brick_log2" (default 5), but what brick_log2_edge says for thin volumes. Throws Error{device_memory}.
BrickLayout device_layout(const Device& device, const Classified& c);

/// The voxels on one device: they change with the volume, and grow with what an appearance shows.
class DeviceBricks {
public:
    /// Uploads the bricks that `c` needs. Throws Error{device_memory} when they do not fit.
    DeviceBricks(Device& device, const Classified& c, const BrickLayout& layout);
    /// Uploads the bricks that another classification of the same voxels needs and that are not there. False, and nothing happens, when the
    /// layout has no room for one.
    bool show(Device& device, const Classified& c);
    const BrickLayout& layout() const { return layout_; }
    /// CLVR_VOXEL, CLVR_POOLS.
    const Defines& defines() const { return defines_; }
    void append_to(BufferList& list) const;

private:
    BrickLayout layout_;
    std::vector<char> present_; // [bricks]
    Buffer offset_, pool_;
    std::vector<Buffer> voxels_;
    Defines defines_;
};

/// How the voxels look on one device: transfer table, majorants, extinction, clip, and where the volume is empty.
class DeviceAppearance {
public:
    /// Waits for the device. Throws Error{device_memory}.
    DeviceAppearance(Device& device, const Classified& c, const shared::VolumeParams& params, const DeviceBricks& bricks);
    void append_to(BufferList& list) const;
    /// [VolumeParams::coarse] the mean opacity of a cell, where something in it is visible; else minus its distance to the next such cell,
    /// the greatest of the three along the axes [cells], or to the far side of the grid and one more where there is none. The cells closer
    /// than that are all empty.
    const Buffer& coarse_opacity() const { return coarse_; }
    const shared::VolumeParams& params() const { return host_params_; }

private:
    shared::VolumeParams host_params_;
    Buffer params_, majorants_, opacity_, color_, coarse_;
};

/// Bricks and appearance: the arguments VOLUME_ARGS of the kernels.
class DeviceVolume {
public:
    /// Throws Error{device_memory} when they do not fit.
    DeviceVolume(Device& device, const Classified& c, const BrickLayout& layout, const shared::VolumeParams& params)
        : bricks_(device, c, layout), appearance_(device, c, params, bricks_) {}
    /// Another classification of the same voxels: uploads tables, and the bricks that become visible. False, and nothing happens, when
    /// there is no room for those.
    bool set_appearance(Device& device, const Classified& c, const shared::VolumeParams& params);
    const Defines& defines() const { return bricks_.defines(); }
    const BrickLayout& layout() const { return bricks_.layout(); }
    /// VOLUME_ARGS, in order.
    BufferList arguments() const;
    const Buffer& coarse_opacity() const { return appearance_.coarse_opacity(); }
    const shared::VolumeParams& params() const { return appearance_.params(); }

private:
    DeviceBricks bricks_;
    DeviceAppearance appearance_;
};

/// Tunables of the packet kernels on a device: lanes, and work-items in a group.
int packet_width(const Device& device);
std::size_t packet_group(const Device& device);

} // namespace clvr
