#include "tools/bench/tuner.hpp"

#include <algorithm>

namespace clvr::bench {

std::vector<Knob> knobs_for(const DeviceFacts& d) {
    const bool cpu = d.type == DeviceType::cpu;
    const int native = d.native_float_width >= 16 ? 16 : d.native_float_width >= 8 ? 8 : 4, width = cpu ? native : 1;
    const std::vector<std::string> network{"GuideNet"}, pixels{"slice", "splat"}, rays{"path trace"},
        marches{"path trace", "feature march"};
    const std::vector<int> widths{1, 4, 8, 16};
    const auto groups = [&](std::vector<int> on_cpu) { return cpu ? on_cpu : std::vector{16, 32, 64, 128, 256}; };
    return {
        {"conv_width", {"GuideNet", "slice", "splat"}, widths, cpu ? 16 : 1, true},
        {"conv_vectors", network, {1, 2, 3, 4, 5, 6}, 5, true},
        {"conv_block", network, {1, 2, 4, 5, 10}, 5, true},
        {"packet", marches, widths, width, true},
        {"packet_run", rays, {1, 4, 8, 16, 32, 64}, width == 1 ? 1 : 16, true},
        {"packet_refill", rays, {1, 2, 4, 8, 12, 16}, std::max(1, width / 4), false},
        {"brick_log2", marches, {3, 4, 5, 6, 7}, 5, true},
        {"micro_pixels", {"training step"}, {1 << 15, 1 << 16, 1 << 17, 1 << 18, 1 << 19, 1 << 20, 1 << 22}, cpu ? 1 << 16 : 1 << 22, true},
        {"gradient_block", {"training step"}, {4, 5, 10, 20}, cpu ? 5 : 10, false},
        {"wave_paths",
         rays,
         {1 << 13, 1 << 14, 1 << 15, 1 << 16, 1 << 17, 1 << 18, 1 << 20, 1 << 21, 1 << 22},
         cpu ? 1 << 16 : 1 << 22,
         true},
        {"conv_group_y", network, {1, 2, 4, 8, 16}, 4, false},
        {"conv_group_x", network, cpu ? std::vector{1, 2, 4} : std::vector{8, 16, 32, 64, 128}, cpu ? 1 : 32, false},
        {"march_pixels", {"feature march"}, {1 << 12, 1 << 14, 1 << 16, 1 << 18}, cpu ? 1 << 14 : 1 << 16, false},
        {"splat_bins", {"splat"}, {1, 2, 4, 8, 16, 32, 64}, cpu ? 64 : 8, false},
        {"pixel_group", {"slice"}, cpu ? std::vector{1, 2, 4, 8, 16} : std::vector{8, 16, 32, 64}, cpu ? 4 : 32, false},
        {"packet_group", marches, groups({1, 2, 4, 8}), width == 1 ? 64 : 1, false},
        {"shade_group", rays, groups({16, 32, 64, 128, 256}), 64, false},
        {"denoise_mib", {"denoise a frame"}, {47, 95, 190, 380}, 380, false},
        {"phantom_group", {"compute volume"}, groups({1, 2, 4, 8}), width == 1 ? 64 : 1, false},
    };
}

const std::vector<std::pair<std::string, std::string>>& untuned() {
    static const std::vector<std::pair<std::string, std::string>> list{
        {"tile_pixels", "how tiles are dealt among devices depends on the picture and on how many devices there are; tests set it"},
    };
    return list;
}

} // namespace clvr::bench
