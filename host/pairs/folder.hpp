// Folders of training pairs: noisy frames of views and their references.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// A view: one or more independent noisy frames and a reference (empty: none was made; another noisy frame serves as target).
struct PairView {
    std::vector<std::string> noisy; ///< EXR paths
    std::string reference;
};

struct PairsFolder {
    std::string split;    ///< "train" or "test"
    std::vector<int> spp; ///< samples per pixel of each noisy frame of a view; empty: pairs.json does not say
    std::vector<PairView> views;
};

/// The format tag of pairs.json.
inline constexpr const char* pairs_format = "pairs/1";

/// Names of a folder's frames.
std::string noisy_name(int view, int frame);
bool is_frame_name(const std::string& name); ///< one of these
std::string reference_name(int view);

/// Reads DIR/pairs.json and checks that all its frames are there (not their pixels). Throws Error{input}: no such file, not complete,
/// empty.
PairsFolder read_pairs(const std::string& folder);

} // namespace clvr
