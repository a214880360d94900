#include "host/train/trainer.hpp"
#include "runtime/system/split_mix.hpp"

#include <utility>

namespace clvr {

namespace {

/// Uniform in 0 .. count-1 (Lemire's multiplication; the bias of 2^-32 count does not matter).
int below(SplitMix64& numbers, int count) { return static_cast<int>((numbers.next() >> 32) * static_cast<std::uint64_t>(count) >> 32); }

} // namespace

std::vector<Crop> epoch_crops(std::uint64_t seed, int epoch, const std::vector<std::pair<int, int>>& sizes, int frames, int patches,
                              int patch, bool augment) {
    SplitMix64 numbers(SplitMix64(seed).next() ^ (static_cast<std::uint64_t>(epoch) * 0xd1342543de82ef95u));
    std::vector<Crop> crops;
    for (std::size_t view = 0; view < sizes.size(); ++view)
        for (int k = 0; k < patches; ++k) {
            Crop crop;
            crop.image = static_cast<int>(view) * frames + below(numbers, frames);
            crop.x = below(numbers, sizes[view].first - patch + 1);
            crop.y = below(numbers, sizes[view].second - patch + 1);
            crop.orientation = augment ? below(numbers, 8) : 0;
            crops.push_back(crop);
        }
    for (std::size_t i = crops.size(); i > 1; --i)
        std::swap(crops[i - 1], crops[static_cast<std::size_t>(below(numbers, static_cast<int>(i)))]);
    return crops;
}

} // namespace clvr
