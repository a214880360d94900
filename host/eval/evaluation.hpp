// Denoisers measured on a folder of test pairs.
#pragma once
#include "host/denoise/baselines.hpp"
#include "host/denoise/model.hpp"
#include "host/frame/metrics.hpp"
#include "runtime/opencl/device.hpp"

#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// A way from a noisy frame to a picture.
struct Candidate {
    std::string name; ///< "noisy", a model's name, "cross-bilateral", "wavelet"
    std::function<Frame(const Frame& noisy)> denoise;
};

/// Settings of the classical denoisers.
struct Baselines {
    CrossBilateral cross_bilateral;
    Wavelet wavelet;
};

Candidate noisy_input(); ///< as it is
Candidate through_model(const Device& device, const std::string& name, const Model& model);

/// The noisy input as it is, the models (name, network), and both classical denoisers, in this order.
std::vector<Candidate> candidates(const Device& device, const std::vector<std::pair<std::string, Model>>& models,
                                  const Baselines& baselines);

/// What one candidate reached.
struct Score {
    std::string name;
    std::vector<Metrics> views;
    Metrics mean; ///< of each measure over the views
};

struct Evaluation {
    std::vector<std::string> views; ///< the noisy frames' files
    std::vector<Score> scores;      ///< in the candidates' order
};

/// Every view of a folder (noisy frame number `frame` of it) through every candidate, against its reference. `seen` is called after each
/// view with the share that is done. Throws Error{input} when the folder has no references or no such frame.
Evaluation evaluate(const std::vector<Candidate>& candidates, const std::string& folder, int frame,
                    const std::function<void(double)>& seen = {});

/// The settings with the best mean PSNR over a folder, each of a 3x3 grid around the defaults (a factor of 2 between neighbours). `views`:
/// over that many of the folder's views, evenly spread; 0: all.
Baselines best_baselines(const Device& device, const std::string& folder, int frame, const std::function<void(double)>& seen = {},
                         int views = 0);

/// Mean of each measure.
Metrics mean_of(const std::vector<Metrics>& views);

} // namespace clvr
