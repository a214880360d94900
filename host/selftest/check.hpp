// The checks of the self-test, each a small function: does this device compute what clvr's results rest on?
#pragma once
#include "runtime/opencl/device.hpp"

#include <string>
#include <vector>

namespace clvr::selftest {

/// What a check found. `expected` and `found` are short texts without line breaks; hashes stand in them in full.
struct Outcome {
    bool ok = false;
    std::string expected, found;
};

struct Check {
    const char* name; ///< a word, unique
    const char* what; ///< what is checked, a few words
    /// Throws Error for what the device does not do at all.
    Outcome (*run)(Device& device);
};

/// All of them, from cheap to dear.
const std::vector<Check>& checks();

// arithmetic_checks.cpp
Outcome check_trust(Device& device);     ///< IEEE arithmetic (runtime/trust/trust.hpp), probed anew
Outcome check_functions(Device& device); ///< bits of kernels/lib/math.clh at every packet width
Outcome check_random(Device& device);    ///< published vectors at every packet width
Outcome check_layout(Device& device);    ///< both compilers agree on the shared structs

// volume_checks.cpp
Outcome check_seams(Device& device);     ///< a ramp across bricks of every edge: its values, and the bits of the volume in one brick
Outcome check_majorants(Device& device); ///< no opacity above the majorant of its cell, along rays
Outcome check_slab(Device& device);      ///< Beer's law, by the marcher and by the path tracer
Outcome check_furnace(Device& device);   ///< a white medium in white light cannot be seen

// picture_checks.cpp: hashes of golden_values.hpp
Outcome check_picture(Device& device);
Outcome check_frame_automatic(Device& device);
Outcome check_frame_gradient(Device& device);
Outcome check_frame_phase(Device& device);
Outcome check_frame_dvr(Device& device);
Outcome check_frame_mip(Device& device);
Outcome check_denoised(Device& device);

// training_checks.cpp
Outcome check_gradient(Device& device); ///< against differences of the loss along each tensor's gradient
Outcome check_training(Device& device); ///< a few steps: the hash of their losses and weights

} // namespace clvr::selftest
