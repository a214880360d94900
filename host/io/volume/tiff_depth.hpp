// TIFF pages that hold several slices (ImageDepth) in a way that libtiff does not decode.
#pragma once
#include "host/io/volume/tiff_page.hpp"

namespace clvr {

/// Whether the current page has more than one slice, in strips or in tiles of several slices: libtiff takes the first only.
bool has_deep_blocks(const TiffFile& file, const TiffForm& form);
/// Decodes the current page, which has such blocks, to width x height x depth of form.type. Throws Error{input} where they are packed
/// otherwise than by deflate or have several channels, and where the file ends before.
void decode_deep_blocks(const TiffFile& file, const TiffForm& form, unsigned char* to);

} // namespace clvr
