// Frames through the neural bilateral grid.
#pragma once
#include "host/denoise/model.hpp"
#include "host/frame/film.hpp"
#include "host/frame/frame.hpp"
#include "runtime/opencl/device.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace clvr {

/// What `clvr denoise --show` writes beside the result: 0..1 planes (guides, weights) and images (levels, premultiplied radiance).
struct DenoiserView {
    bool guides = false, weights = false, levels = false;
};

class Denoiser {
public:
    /// Builds the kernels and uploads the weights. Throws Error.
    Denoiser(const Device& device, const Model& model);
    ~Denoiser();

    /// The frame with R G B replaced by the denoised beauty (not below 0) and the input's beauty as noisy.R G B. Other channels and
    /// attributes stay; "clvr.denoised" is added. A background (background.R G B) is subtracted first and added below the result at the
    /// end. Where the frame has variances (from 2 samples per pixel on), the result goes back towards the input as the input converges.
    /// Non-finite values are repaired and counted in repaired(). `show` adds the channels guide.1 ..., weight.1 ..., level1.R .... A
    /// picture of any size: what the device does not hold at once goes through in overlapping tiles, with the same bits. Throws
    /// Error{input} naming a channel that the model reads and the frame lacks (and what it has); Error{device_memory}.
    Frame denoise(const Frame& frame, const DenoiserView& show = {});

    /// A film on this device, in place: R G B A become the result, the input stays in noisy.R G B A. The same bits as for the frame that
    /// the film holds; other channels stay. The film holds no value that is not finite and lies over nothing. Throws Error{interrupted}
    /// when `cancelled`, which it looks at now and then, is true: R G B A then hold anything, and the input has to be made again.
    void denoise(Film& film, const std::atomic<bool>* cancelled = nullptr);

    /// Has the programs built that a picture takes, on a thread of their own, while its channels are made or gathered. `variances`: it has
    /// them.
    void prepare(int width, int height, bool variances, bool show_levels = false);

    /// Values of the last frame that were not finite.
    std::size_t repaired() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace clvr
