// A volume and its classification on one device: the arguments VOLUME_ARGS of the kernels.
#pragma once
#include "host/volume/bricks.hpp"
#include "kernels/shared/volume_params.h"
#include "runtime/device.hpp"

namespace clvr {

/// The volume prepared for a classification, on the host: independent of the device.
struct Classified {
    const Voxels* voxels = nullptr;
    const MajorantGrid* grid = nullptr;
    TransferTable table;
    std::vector<float> majorants;
};

/// Where the bricks of a classified volume go on a device. Brick edge: tunable "brick_log2" (default 5), but what brick_log2_edge says for
/// thin volumes.
BrickLayout device_layout(const Device& device, const Classified& c);

class DeviceVolume {
public:
    /// Uploads bricks, majorants and tables. Throws Error{memory} when they do not fit.
    DeviceVolume(Device& device, const Classified& c, const BrickLayout& layout, const shared::VolumeParams& params);
    /// CLVR_VOXEL, CLVR_POOLS.
    const Defines& defines() const { return defines_; }
    /// VOLUME_ARGS, in order.
    BufferList arguments() const;
    /// [VolumeParams::coarse] mean opacity, or minus the distance to the next cell that has some (coarse_opacity.hpp).
    const Buffer& coarse_opacity() const { return coarse_; }
    const shared::VolumeParams& params() const { return host_params_; }

private:
    shared::VolumeParams host_params_;
    Buffer params_, majorants_, opacity_, color_, offset_, pool_, coarse_;
    std::vector<Buffer> voxels_;
    Defines defines_;
};

/// The packet width of the trackers on a device: tunable "packet", default 16, 8 or 4 by the CPU's native vectors, 1 elsewhere and on
/// simulators.
int packet_width(const Device& device);
/// Work-items in a group of a kernel of so wide packets (1: of single paths): the tunable, else by device facts. An interpreter keeps what
/// every instruction of a group computed until the group ends (Oclgrind: core/WorkItem.h, m_pool), so its groups have one work-item.
std::size_t packet_group(const Device& device, int width);

} // namespace clvr
