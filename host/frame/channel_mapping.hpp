// Channels under the names that other renderers give them.
#pragma once
#include "host/frame/frame.hpp"

#include <string>
#include <vector>

namespace clvr {

/// What a layer of another renderer's file holds, by its usual spellings in any case, with or without the view layer's name before it
/// ("ViewLayer.Denoising Albedo"): "beauty", "albedo", "normal", "depth"; empty: not known.
std::string known_pass(const std::string& layer);

/// "albedo=DiffCol" takes DiffCol.R as albedo.R and so on (r, g, b and x, y, z too; R G B of a normal are X Y Z), "depth.Z=Depth.V" one
/// channel; "beauty" is R G B A. Throws Error{usage} for another form, Error{input} when there is no such channel or layer, naming what
/// there is.
void map_channels(Frame& frame, const std::string& mapping);

/// Where the frame lacks the beauty, albedo, normal or depth under clvr's names and has them under another known one, takes them from
/// there. Returns a sentence for each. A depth that is a share 0..1, as clvr's, is taken too; of distances it says that they are not.
std::vector<std::string> map_known_channels(Frame& frame);

} // namespace clvr
