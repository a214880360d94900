#include "host/train/trainer.hpp"

#include <utility>

namespace clvr {

namespace {

/// Whole numbers from (seed, epoch): SplitMix64 (Steele, Lea, Flood 2014).
struct Numbers {
    std::uint64_t state;
    std::uint64_t next() {
        std::uint64_t z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// Uniform in 0 .. count-1 (Lemire's multiplication; the bias of 2^-32 count does not matter).
    int below(int count) { return static_cast<int>((next() >> 32) * static_cast<std::uint64_t>(count) >> 32); }
};

} // namespace

std::vector<Crop> epoch_crops(std::uint64_t seed, int epoch, const std::vector<std::pair<int, int>>& sizes, int frames, int patches,
                              int patch, bool augment) {
    Numbers numbers{seed};
    numbers.state = numbers.next() ^ (static_cast<std::uint64_t>(epoch) * 0xd1342543de82ef95u);
    std::vector<Crop> crops;
    for (std::size_t view = 0; view < sizes.size(); ++view)
        for (int k = 0; k < patches; ++k) {
            Crop crop;
            crop.image = static_cast<int>(view) * frames + numbers.below(frames);
            crop.x = numbers.below(sizes[view].first - patch + 1);
            crop.y = numbers.below(sizes[view].second - patch + 1);
            crop.orientation = augment ? numbers.below(8) : 0;
            crops.push_back(crop);
        }
    for (std::size_t i = crops.size(); i > 1; --i)
        std::swap(crops[i - 1], crops[static_cast<std::size_t>(numbers.below(static_cast<int>(i)))]);
    return crops;
}

} // namespace clvr
