// Whether two scenes agree in a part that a RenderSession is given alone.
#pragma once
#include "host/render/scene.hpp"

namespace clvr {

/// Names of transfer functions do not count: they show nothing.
bool same(const Appearance& a, const Appearance& b);
bool same(const Viewpoint& a, const Viewpoint& b);
bool same(const Light& a, const Light& b);
bool same_size(const Scene& a, const Scene& b);
/// Whether they need the same tables of their environment.
bool same_environment(const Light& a, const Light& b);
/// Whether the samples of one are the other's: all but spp, features, and what lies behind and after the picture agrees.
bool same_samples(const Scene& a, const Scene& b);

} // namespace clvr
