// Drivers that the OpenCL loader skips without a word.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// One line for each driver that is registered where the loader looks (OCL_ICD_VENDORS: a folder of .icd files, one such file or a library;
/// else /etc/OpenCL/vendors) and cannot be loaded, or is no driver: file, library and why.
std::vector<std::string> unloadable_drivers();

} // namespace clvr
