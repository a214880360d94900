#include "host/eval/evaluation.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/pairs/folder.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <deque>
#include <fmt/format.h>
#include <future>
#include <memory>
#include <thread>

namespace clvr {

namespace {

constexpr double Metrics::*measures[] = {&Metrics::psnr,  &Metrics::ssim,   &Metrics::ssim_opaque, &Metrics::rmse,
                                         &Metrics::smape, &Metrics::relmse, &Metrics::flip};

PairsFolder with_references(const std::string& folder, int frame) {
    PairsFolder pairs = read_pairs(folder);
    const int frames = static_cast<int>(pairs.views.front().noisy.size());
    if (frame < 0 || frame >= frames)
        throw Error(ErrorKind::input, fmt::format("has {} noisy frames a view, from 0 on; no number {}", frames, frame), folder);
    if (pairs.views.front().reference.empty()) throw Error(ErrorKind::input, "has no references to measure against", folder);
    return pairs;
}

/// Runs f with a file's name added to errors that lack one.
template <class F>
auto naming(const std::string& file, F f) {
    try {
        return f();
    } catch (const Error& e) {
        throw e.where().empty() ? Error(e.kind(), e.what(), file) : e;
    }
}

} // namespace

Metrics mean_of(const std::vector<Metrics>& views) {
    Metrics mean;
    for (const auto measure : measures) {
        for (const Metrics& m : views) mean.*measure += m.*measure;
        mean.*measure /= static_cast<double>(views.size());
    }
    return mean;
}

Candidate noisy_input() {
    return {"noisy", [](const Frame& noisy) { return noisy; }};
}

Candidate through_model(const Device& device, const std::string& name, const Model& model) {
    const auto denoiser = std::make_shared<Denoiser>(device, model);
    return {name, [denoiser](const Frame& noisy) { return denoiser->denoise(noisy); }};
}

std::vector<Candidate> candidates(const Device& device, const std::vector<std::pair<std::string, Model>>& models,
                                  const Baselines& baselines) {
    std::vector<Candidate> all{noisy_input()};
    for (const auto& [name, model] : models) all.push_back(through_model(device, name, model));
    all.push_back({"cross-bilateral", [=](const Frame& noisy) { return denoise(device, noisy, baselines.cross_bilateral); }});
    all.push_back({"wavelet", [=](const Frame& noisy) { return denoise(device, noisy, baselines.wavelet); }});
    return all;
}

Evaluation evaluate(const std::vector<Candidate>& candidates, const std::string& folder, int frame,
                    const std::function<void(double)>& seen) {
    const PairsFolder pairs = with_references(folder, frame);
    const auto noisy_of = [&](const PairView& view) { return view.noisy[static_cast<std::size_t>(frame)]; };
    Evaluation e;
    for (const auto& c : candidates) e.scores.push_back({c.name, {}, {}});
    // Metrics are taken on threads, of several views at once where there are cores for them, while the device denoises the next view.
    std::deque<std::vector<std::future<Metrics>>> waiting;
    const std::size_t views_at_once = std::max<std::size_t>(1, std::thread::hardware_concurrency() / candidates.size());
    const auto settle = [&] {
        const std::size_t view = e.scores.front().views.size();
        naming(e.views[view], [&] {
            for (std::size_t k = 0; k < candidates.size(); ++k) e.scores[k].views.push_back(waiting.front()[k].get());
        });
        waiting.pop_front();
        if (seen) seen(static_cast<double>(view + 1) / static_cast<double>(pairs.views.size()));
    };
    for (const auto& view : pairs.views) {
        if (waiting.size() == views_at_once) settle();
        const Frame noisy = read_exr(noisy_of(view));
        const auto reference = std::make_shared<const Frame>(read_exr(view.reference));
        e.views.push_back(noisy_of(view));
        waiting.emplace_back();
        naming(e.views.back(), [&] {
            for (const Candidate& c : candidates)
                waiting.back().push_back(std::async(
                    std::launch::async, [picture = c.denoise(noisy), reference] { return compare_frames(picture, *reference); }));
        });
    }
    while (!waiting.empty()) settle();
    for (Score& s : e.scores) s.mean = mean_of(s.views);
    return e;
}

Baselines best_baselines(const Device& device, const std::string& folder, int frame, const std::function<void(double)>& seen, int views) {
    PairsFolder pairs = with_references(folder, frame);
    const std::size_t there = pairs.views.size(),
                      wanted = views > 0 ? std::min<std::size_t>(there, static_cast<std::size_t>(views)) : there;
    for (std::size_t k = 0; k < wanted; ++k) pairs.views[k] = pairs.views[k * there / wanted];
    pairs.views.resize(wanted);
    const auto noisy_of = [&](const PairView& view) { return view.noisy[static_cast<std::size_t>(frame)]; };
    constexpr double factors[] = {0.5, 1, 2};
    std::vector<Baselines> grid;
    for (const double first : factors)
        for (const double second : factors) {
            Baselines b;
            b.cross_bilateral.spatial *= first, b.cross_bilateral.feature *= second;
            b.wavelet.colour *= first, b.wavelet.feature *= second;
            grid.push_back(b);
        }
    std::vector<double> bilateral(grid.size()), wavelet(grid.size());
    double done = 0;
    for (const auto& view : pairs.views) {
        const Frame noisy = read_exr(noisy_of(view)), reference = read_exr(view.reference);
        naming(noisy_of(view), [&] {
            std::vector<std::pair<std::future<double>, std::future<double>>> scores; // while the device makes the next picture
            const auto score = [&](const auto& settings) {
                return std::async(std::launch::async, [&, picture = denoise(device, noisy, settings)] { return psnr(picture, reference); });
            };
            for (const Baselines& b : grid) scores.emplace_back(score(b.cross_bilateral), score(b.wavelet));
            for (std::size_t k = 0; k < grid.size(); ++k) {
                bilateral[k] += scores[k].first.get();
                wavelet[k] += scores[k].second.get();
            }
        });
        if (seen) seen((done += 1) / static_cast<double>(pairs.views.size()));
    }
    const auto best = [&](const std::vector<double>& sums) {
        return grid[static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin())];
    };
    return {best(bilateral).cross_bilateral, best(wavelet).wavelet};
}

} // namespace clvr
