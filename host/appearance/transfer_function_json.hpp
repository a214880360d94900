// Transfer functions as parsed JSON values: clvr's own form and ParaView's.
#pragma once
#include "host/appearance/transfer_function.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clvr {

/// A transfer function of either form inside a larger file. Throws Error{input}.
TransferFunction parse_transfer_function(const nlohmann::json& file, const std::string& where);

/// The first colour map of a ParaView export: `RGBPoints` (value, r, g, b) through its `ColorSpace` (RGB, HSV, HSVNoWrap, Lab, Diverging,
/// Step), and `Points` (value, opacity, midpoint, sharpness) as vtkPiecewiseFunction interpolates them; without `Points` the opacity rises
/// from 0 to 1 along the colours. Diverging goes through Lab instead of Msh, through white where ParaView does. Values of exactly 0..1 are
/// normalized ones (ParaView fits such a map to its data), others physical. Curves become short straight pieces. Members that are not
/// needed are ignored, unlike in clvr's own form. Throws Error{input}.
TransferFunction from_paraview_json(const nlohmann::json& file, const std::string& where);

} // namespace clvr
