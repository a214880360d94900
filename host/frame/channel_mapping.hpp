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

/// Takes the beauty, albedo, normal or depth from a channel of another known name where the frame lacks it under clvr's name. Returns a
/// sentence for each. A depth is taken where it is a share 0..1, as clvr's is; where it is a distance, a sentence says that it is not.
std::vector<std::string> map_known_channels(Frame& frame);

} // namespace clvr
