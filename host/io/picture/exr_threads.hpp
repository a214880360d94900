// How many threads OpenEXR takes.
#pragma once

namespace clvr {

/// OpenEXR packs and unpacks lines on all cores after this; by itself it takes one.
void use_all_cores();

} // namespace clvr
