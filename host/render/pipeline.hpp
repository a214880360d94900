// A volume's picture from the first sample to the last filter.
#pragma once
#include "host/denoise/denoiser.hpp"
#include "host/render/session.hpp"

#include <optional>

namespace clvr {

/// What is made of a session's samples: denoised by a model, or left as they are. Keeps kernels and memory from picture to picture.
class Pipeline {
public:
    explicit Pipeline(std::optional<Model> model = {}) : model_(std::move(model)) {}
    /// Brings the session to the scene, of which it has set all but spp, mode and features: samples, features (where the scene wants them
    /// or the model reads them), denoiser, blend. Then session.frame() or picture() lays the background and gives the picture. Light
    /// features are marched where `control.light` says so or the model reads them. Throws as take() and Denoiser do.
    void run(RenderSession& session, const Scene& scene, RenderControl control);

    /// The two halves of run(). `cancelled`: stops the filter, where the picture is on a device, with Error{interrupted}.
    void take(RenderSession& session, const Scene& scene, RenderControl control);
    void filter(RenderSession& session, const std::atomic<bool>* cancelled = nullptr);

private:
    std::optional<Model> model_;
    std::optional<Denoiser> denoiser_; // on
    std::optional<Device> on_;

    Denoiser& denoiser_on(Device& device);
};

} // namespace clvr
