#include "host/render/marcher.hpp"

#include <algorithm>
#include <string>

namespace clvr {

Marcher::Marcher(Device& device, const DeviceVolume& volume, const LightTables& light, March march, int rays)
    : device_(device), volume_(volume), light_(light), march_(march), width_(packet_width(device)) {
    Defines defines = volume.defines();
    defines["CLVR_WIDTH"] = std::to_string(width_);
    defines["CLVR_RAYS"] = std::to_string(rays);
    defines["CLVR_MARCH"] = std::to_string(static_cast<int>(march));
    kernel_ = device_.kernel("render/march", defines);
    planes_ = device_.buffer(std::size_t{4} * march_planes(march) * pixels_per_launch, "feature planes");
}

void Marcher::run(std::uint32_t first_pixel, std::uint32_t pixels, std::vector<float>& planes, std::size_t stride, std::size_t offset) {
    const Range group = kernel_.group(static_cast<std::size_t>(device_.tunable("packet_group", width_ == 1 ? 64 : 1)));
    for (std::uint32_t done = 0; done < pixels; done += pixels_per_launch) {
        const std::uint32_t n = std::min(pixels_per_launch, pixels - done);
        device_.launch(kernel_, {(n + width_ - 1) / width_}, group, {}, volume_.arguments(), light_.render(), first_pixel + done, n,
                       pixels_per_launch, planes_);
        for (int p = 0; p < march_planes(march_); ++p)
            device_.read(planes_, &planes[p * stride + offset + done], n * 4, std::size_t{4} * p * pixels_per_launch);
    }
}

} // namespace clvr
