// The names of a frame's channels and attributes (host/README.md, "Frames"): typed here, used everywhere.
#pragma once
#include <array>

namespace clvr {

namespace channel {

using Names = std::array<const char*, 3>;
inline constexpr Names colour{"R", "G", "B"};
inline constexpr Names variance{"variance.R", "variance.G", "variance.B"};
inline constexpr Names albedo{"albedo.R", "albedo.G", "albedo.B"};
inline constexpr Names normal{"normal.X", "normal.Y", "normal.Z"};
inline constexpr Names light_key{"light.key.R", "light.key.G", "light.key.B"};
inline constexpr Names light_sky{"light.sky.R", "light.sky.G", "light.sky.B"};
inline constexpr Names background{"background.R", "background.G", "background.B"};
inline constexpr Names noisy{"noisy.R", "noisy.G", "noisy.B"};
inline constexpr const char* alpha = "A";
inline constexpr const char* noisy_alpha = "noisy.A";
inline constexpr const char* opacity = "opacity.A";
inline constexpr const char* depth = "depth.Z";
inline constexpr const char* depth_deviation = "depth.deviation";
inline constexpr const char* depth_half = "depth.half";

} // namespace channel

namespace attribute {

inline constexpr const char* version = "clvr.version";
inline constexpr const char* scene = "clvr.scene";
inline constexpr const char* seed = "clvr.seed";
inline constexpr const char* spp = "clvr.spp";
inline constexpr const char* volume_sha256 = "clvr.volume.sha256";
inline constexpr const char* device = "clvr.device";
inline constexpr const char* kernels_sha256 = "clvr.kernels.sha256";
inline constexpr const char* denoised = "clvr.denoised";

} // namespace attribute

} // namespace clvr
