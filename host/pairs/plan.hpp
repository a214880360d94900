// What a folder of pairs holds: pairs.json.
#pragma once
#include "host/render/session.hpp"
#include "host/render/view_set.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace clvr {

/// All that decides the frames of a folder. Each view has a reference (unless reference_spp is 0) and `noisy_frames` noisy ones.
struct PairsPlan {
    std::string split = "train"; ///< or "test": other views, other noise
    std::vector<int> spp{1};     ///< of the noisy frames, in turn
    int reference_spp = 1024, noisy_frames = 1;
    std::uint64_t seed = 0;
    std::vector<Scene> scenes; ///< one per transfer function; view v is of scene v modulo their number
    std::vector<ViewPoint> views;
};

/// The text of pairs.json: the same plan has the same text.
std::string to_json(const PairsPlan& plan);
/// Throws Error{input}: `where` names the file.
PairsPlan parse_pairs_plan(const std::string& text, const std::string& where);

/// The views of a split: `count` around the volume, zooms uniform between the two.
std::vector<ViewPoint> split_views(const std::string& split, std::uint64_t seed, int count, double zoom_low, double zoom_high);

/// The scene of one frame of a view: role 0 is the reference, 1 .. the noisy ones.
Scene frame_scene(const PairsPlan& plan, int view, int role);

/// Fixes the defaults that depend on the voxels, so that pairs.json does not change with later defaults. Throws Error{input} when the plan
/// is of other voxels.
void settle(PairsPlan& plan, const PreparedVolume& volume);

} // namespace clvr
