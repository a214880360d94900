// A live picture as the page gets it: 32 bytes of header, then JPEG or PNG.
#pragma once
#include "host/live/picture.hpp"
#include "host/view/client_queue.hpp"

namespace clvr::view {

/// JPEG q80 with halved colours while the scene moves, q92 with full colours while samples are added, PNG once the picture is settled. JPEG
/// has no alpha: it lies over black, mixed as a browser mixes the PNG. `width`, `height`: the scene's.
EncodedPicture encode(const LivePicture& picture, int width, int height);

} // namespace clvr::view
