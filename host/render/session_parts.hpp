// What a RenderSession is made of; for its own files.
#pragma once
#include "host/render/device_lights.hpp"
#include "host/render/direct_light.hpp"
#include "host/render/session.hpp"

namespace clvr {

/// The planes of a traced picture, in order; a march leaves the first four.
inline const std::vector<std::string> beauty_channels{"R", "G", "B", "A", "variance.R", "variance.G", "variance.B"};

/// A marcher, and what it was made for.
struct RenderSession::Marching {
    March kind;
    int rays;
    bool lit;
    Marcher marcher;
};

/// One device's share of the work.
struct RenderSession::Worker {
    Device device;
    std::shared_ptr<DeviceVolume> volume; // sub-devices of one context share it
    std::optional<DeviceLights> lights;
    std::optional<KeyLights> keys;       // of the view
    std::shared_ptr<const SkyLight> sky; // of all views; shared as the volume is
    std::optional<PathTracer> tracer;
    std::optional<Marching> marching;       // kept for the next view
    std::optional<PixelSums> before, after; // of a chunk, while the picture is kept on the host
    bool compared = false;                  // with the others

    /// Before what they refer to goes.
    void forget_passes() { tracer.reset(), marching.reset(); }
};

/// The picture on the host.
struct RenderSession::HostSums {
    struct Sums {
        std::vector<shared::float4> mean, deviation;
    };
    Sums sums, next; // of whole passes, and of the pass that runs
    Frame channels;
    std::optional<Frame> filtered; // over nothing
};

} // namespace clvr
