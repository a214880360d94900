// What OpenEXR does not do by itself.
#pragma once
#include <string>

namespace clvr {

/// OpenEXR packs and unpacks lines on all cores after this; by itself it takes one.
void use_all_cores();

/// Walks the headers of a file. Throws Error{input} where an attribute is longer than the file: OpenEXR 3.1 allocates it before it finds
/// out.
void check_attribute_sizes(const std::string& path);

} // namespace clvr
