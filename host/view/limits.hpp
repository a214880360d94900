// What one viewer gives to all of its clients at most.
#pragma once
#include <cstddef>

namespace clvr::view {

inline constexpr std::size_t largest_message = std::size_t{64} << 10; ///< of a client [bytes]
inline constexpr std::size_t largest_upload = std::size_t{64} << 20;  ///< [bytes]
inline constexpr int largest_side = 4096;                             ///< of a picture [pixels]
inline constexpr int largest_samples = 65536;                         ///< per pixel
inline constexpr int largest_views = 720;                             ///< of a turntable
inline constexpr std::size_t most_clients = 8;
inline constexpr std::size_t most_jobs = 16;   ///< that are remembered with their files
inline constexpr std::size_t most_uploads = 4; ///< that are kept

} // namespace clvr::view
