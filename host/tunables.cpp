// The list of all tunables, which CMake puts into clvr_runtime: the runtime reads it and knows none of them by name.
#include "host/denoise/tunables.hpp"
#include "host/phantom/tunables.hpp"
#include "host/render/tunables.hpp"
#include "host/train/tunables.hpp"

namespace clvr {

const std::vector<const Tunable*>& declared_tunables() {
    using namespace tunables;
    static const std::vector<const Tunable*> all{
        &conv_width,   &conv_vectors,   &conv_block,  &packet,       &packet_run,    &packet_refill, &brick_log2,
        &micro_pixels, &gradient_block, &wave_paths,  &conv_group_y, &conv_group_x,  &march_pixels,  &splat_bins,
        &pixel_group,  &packet_group,   &shade_group, &denoise_mib,  &phantom_group, &tile_pixels,   &band_pixels};
    return all;
}

} // namespace clvr
