// Whole pictures, by their hashes.
#include "host/frame/frame.hpp"
#include "host/selftest/check.hpp"
#include "host/selftest/golden.hpp"

namespace clvr::selftest {
namespace {

Outcome compared(const Frame& frame, const std::string& hash) {
    const std::string found = pixel_hash(frame);
    return {found == hash, hash, found};
}

Outcome check_frame(Device& device, const std::string& name) { return compared(render_golden(name, {device}), golden_hashes.at(name)); }

} // namespace

Outcome check_picture(Device& device) { return compared(golden_picture(device), golden_picture_hash); }
Outcome check_frame_automatic(Device& device) { return check_frame(device, "automatic"); }
Outcome check_frame_gradient(Device& device) { return check_frame(device, "gradient"); }
Outcome check_frame_phase(Device& device) { return check_frame(device, "phase"); }
Outcome check_frame_dvr(Device& device) { return check_frame(device, "dvr"); }
Outcome check_frame_mip(Device& device) { return check_frame(device, "mip"); }
Outcome check_denoised(Device& device) { return compared(golden_denoised(device), golden_denoised_hash); }

} // namespace clvr::selftest
