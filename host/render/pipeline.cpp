#include "host/render/pipeline.hpp"
#include "host/denoise/channels.hpp"

#include <utility>

namespace clvr {

void Pipeline::run(RenderSession& session, const Scene& scene, RenderControl control) {
    take(session, scene, std::move(control));
    filter(session);
}

void Pipeline::take(RenderSession& session, const Scene& scene, RenderControl control) {
    Scene wanted = scene;
    wanted.features |= model_.has_value();
    control.light |= model_ && reads_light(*model_);
    if (model_ && !denoiser_) { // programs are built while others compute
        std::vector<Device> devices = session.devices();
        denoiser_on(devices.front()).prepare(scene.width, scene.height, scene.spp > 1);
    }
    clvr::take(session, wanted, control);
}

/// Where the session keeps the picture on a device, it is denoised there; else on the first device that can.
void Pipeline::filter(RenderSession& session, const std::atomic<bool>* cancelled) {
    if (!model_) return;
    if (Film* const film = session.film()) return denoiser_on(film->device()).denoise(*film, cancelled);
    const Frame noisy = session.frame();
    std::vector<Device> devices = session.devices();
    session.set_filtered(on_first(devices, [&](Device& device) { return denoiser_on(device).denoise(noisy); }));
}

Denoiser& Pipeline::denoiser_on(Device& device) {
    if (!denoiser_ || !is_same(*on_, device)) denoiser_.emplace(device, *model_);
    on_ = device;
    return *denoiser_;
}

} // namespace clvr
