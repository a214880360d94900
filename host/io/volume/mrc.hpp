// The header of MRC and CCP4 maps.
#pragma once
#include <string>

namespace clvr {

constexpr std::size_t mrc_header_bytes = 1024;

/// Whether a file that starts so is one: marked with "MAP", as all since the year 2000 are, with plausible sizes, mode and axes.
bool is_mrc_header(const std::string& head);

} // namespace clvr
