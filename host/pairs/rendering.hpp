// Renders folders of pairs, and continues unfinished ones.
#pragma once
#include "host/pairs/plan.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// Makes the folder and writes the plan as its pairs.json; a pairs.json that is there must hold the same plan. Throws Error{input}: the
/// folder cannot be made, or holds pairs of another plan.
void begin_pairs_folder(const std::string& folder, const PairsPlan& plan);

/// Whether the folder holds every frame of its pairs.json.
bool pairs_complete(const std::string& folder);

/// Renders the frames of a settled plan that the folder lacks. `progress` gets the number of views done before each frame. Returns the
/// number of views that are complete: fewer than the plan's only when `interrupted` was set.
int render_pairs(std::vector<Device>& devices, const PreparedVolume& volume, const EnvironmentTables& environment, const PairsPlan& plan,
                 const std::string& folder, const std::atomic<bool>& interrupted, const std::function<void(int)>& progress);

} // namespace clvr
