#include "host/denoise/model.hpp"
#include "host/frame/names.hpp"
#include "kernels/shared/denoise_params.h"
#include "runtime/error.hpp"
#include "runtime/system/split_mix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace clvr {

namespace {

std::vector<std::string> joined(std::initializer_list<channel::Names> groups, std::initializer_list<const char*> single) {
    std::vector<std::string> names;
    for (const channel::Names& group : groups) names.insert(names.end(), group.begin(), group.end());
    names.insert(names.end(), single.begin(), single.end());
    return names;
}

const std::vector<std::string>& known_channels() {
    using namespace channel;
    static const std::vector<std::string> names = joined({colour, albedo, normal, variance, {"known.R", "known.G", "known.B"}},
                                                         {alpha, depth, depth_deviation, depth_half, opacity, "noise"});
    return names;
}

template <class Tensors>
auto tensors_of(Tensors& m) {
    return std::array{&m.conv1_weight, &m.conv1_bias, &m.conv2_weight, &m.conv2_bias};
}

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorKind::input, what); }

void check_range(const char* name, int value, int low, int high) {
    if (value < low || value > high) fail(fmt::format("model: {} is {}; expected {} to {}", name, value, low, high));
}

} // namespace

std::vector<std::string> reference_channels() { return joined({channel::colour, channel::albedo, channel::normal}, {channel::depth}); }

Model default_settings() {
    Model m;
    m.channels = reference_channels();
    m.channels.insert(m.channels.end(), {channel::opacity, channel::depth_deviation, channel::depth_half, "noise"});
    m.exposure = true;
    m.albedo_floor = 1.0f / 32;
    m.opacity_weight = true;
    return m;
}

std::vector<float> Model::flat() const {
    std::vector<float> all;
    for (const auto* t : tensors_of(*this)) all.insert(all.end(), t->begin(), t->end());
    return all;
}

void Model::set_flat(const std::vector<float>& values) {
    if (values.size() != parameters())
        throw Error(ErrorKind::internal, fmt::format("{} parameters for a model of {}", values.size(), parameters()));
    auto at = values.begin();
    for (auto* t : tensors_of(*this)) {
        std::copy(at, at + static_cast<std::ptrdiff_t>(t->size()), t->begin());
        at += static_cast<std::ptrdiff_t>(t->size());
    }
}

void initialise(Model& m, std::uint64_t seed) {
    const std::size_t taps = static_cast<std::size_t>(m.kernel) * m.kernel, in = m.channels.size(),
                      hidden = static_cast<std::size_t>(m.hidden), out = static_cast<std::size_t>(m.outputs());
    SplitMix64 numbers(seed);
    const auto uniform = [&] { return static_cast<double>(numbers.next() >> 40) / (1 << 24); };
    const auto glorot = [&](std::vector<float>& to, std::size_t from, std::size_t count) {
        const double limit = std::sqrt(6.0 / static_cast<double>(taps * (from + count)));
        to.resize(taps * from * count);
        for (float& w : to) w = static_cast<float>((2 * uniform() - 1) * limit);
    };
    glorot(m.conv1_weight, in, hidden);
    glorot(m.conv2_weight, hidden, out);
    m.conv1_bias.assign(hidden, 0);
    m.conv2_bias.assign(out, 0);
}

void add_known_light(Model& m) {
    m.control_variate_cell = 32;
    if (m.control_variate) return;
    m.control_variate = true;
    const std::size_t taps = static_cast<std::size_t>(m.kernel) * m.kernel, before = m.channels.size();
    for (const char* name : {"known.R", "known.G", "known.B"})
        if (std::find(m.channels.begin(), m.channels.end(), name) == m.channels.end()) m.channels.emplace_back(name);
    std::vector<float> wider;
    for (std::size_t h = 0; h < static_cast<std::size_t>(m.hidden); ++h) {
        const auto row = m.conv1_weight.begin() + static_cast<std::ptrdiff_t>(h * before * taps);
        wider.insert(wider.end(), row, row + static_cast<std::ptrdiff_t>(before * taps));
        wider.resize(wider.size() + (m.channels.size() - before) * taps);
    }
    m.conv1_weight = std::move(wider);
}

void validate_levels(const std::vector<Model::Level>& levels) {
    check_range("the number of levels", static_cast<int>(levels.size()), 1, CLVR_LEVELS_MAX);
    for (const auto& level : levels) {
        check_range("a level's pixels per cell", level.pixels, 1, 64);
        check_range("a level's codes per cell", level.codes, 4, 256);
    }
}

void validate(const Model& m) {
    check_range("the number of channels", static_cast<int>(m.channels.size()), 1, 64);
    std::set<std::string> seen;
    for (const auto& name : m.channels) {
        const auto& known = known_channels();
        if (std::find(known.begin(), known.end(), name) == known.end())
            fail(fmt::format("model: channel \"{}\" is unknown; known are {}", name, fmt::join(known, " ")));
        if (!seen.insert(name).second) fail(fmt::format("model: channel \"{}\" is listed twice", name));
    }
    check_range("the number of hidden channels", m.hidden, 1, 256);
    check_range("the kernel size", m.kernel, 1, 15);
    if (m.kernel % 2 == 0) fail(fmt::format("model: the kernel size is {}; expected an odd number", m.kernel));
    validate_levels(m.levels);
    if (m.control_variate_cell != 0) check_range("the control variate's pixels per cell", m.control_variate_cell, 8, 256);
    if (!(m.albedo_floor > 0 && m.albedo_floor <= 1))
        fail(fmt::format("model: the albedo floor is {}; expected above 0, up to 1", m.albedo_floor));
    const std::size_t taps = static_cast<std::size_t>(m.kernel) * m.kernel, hidden = static_cast<std::size_t>(m.hidden),
                      out = static_cast<std::size_t>(m.outputs());
    const std::size_t expected[] = {hidden * m.channels.size() * taps, hidden, out * hidden * taps, out};
    const char* names[] = {"conv1.weight", "conv1.bias", "conv2.weight", "conv2.bias"};
    const auto tensors = tensors_of(m);
    for (std::size_t t = 0; t < tensors.size(); ++t) {
        if (tensors[t]->size() != expected[t])
            fail(fmt::format("model: {} has {} values; expected {}", names[t], tensors[t]->size(), expected[t]));
        if (!std::all_of(tensors[t]->begin(), tensors[t]->end(), [](float w) { return std::isfinite(w); }))
            fail(fmt::format("model: {} has a value that is not finite", names[t]));
    }
}

} // namespace clvr
