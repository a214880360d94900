#include "runtime/trust/trust.hpp"

#include "kernels/shared/trust_operations.h"
#include "runtime/opencl/fault.hpp"
#include "runtime/opencl/program.hpp"
#include "runtime/opencl/program_cache.hpp"
#include "runtime/opencl/source.hpp"
#include "runtime/system/folders.hpp"
#include "runtime/system/hashes.hpp"
#include "runtime/system/split_mix.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <mutex>

namespace clvr {
namespace {

constexpr std::size_t vectors = 10240;
constexpr const char* trust_version = "trust 1"; // of the operands and of the stored form

std::uint32_t bits(float x) {
    std::uint32_t result;
    std::memcpy(&result, &x, sizeof result);
    return result;
}

float from_bits(std::uint32_t x) {
    float result;
    std::memcpy(&result, &x, sizeof result);
    return result;
}

/// The operands are the same in every run.
class Random {
public:
    std::uint32_t next() { return static_cast<std::uint32_t>(numbers_.next() >> 32); }
    /// 2^low <= |x| < 2^(high + 1), all mantissas.
    float normal(int low, int high, bool negative) {
        const std::uint32_t exponent = static_cast<std::uint32_t>(127 + low) + next() % static_cast<std::uint32_t>(high - low + 1);
        return from_bits((negative ? 0x80000000u : 0u) | exponent << 23 | next() >> 9);
    }
    bool coin() { return next() >> 31; }

private:
    SplitMix64 numbers_{2026};
};

struct Operands {
    std::vector<float> a, b, c, r, s, t, w;
    std::vector<std::uint32_t> u, v;
};

Operands make_operands() {
    Operands o;
    Random random;
    for (std::size_t i = 0; i < vectors; ++i) {
        const float a = random.normal(-30, 30, random.coin()), b = random.normal(-30, 30, random.coin());
        o.a.push_back(a);
        o.b.push_back(b);
        o.c.push_back(i % 2 ? -(a * b) * (1 + static_cast<float>(i % 8) * 0x1p-23f) : random.normal(-30, 30, random.coin()));
        const float half = static_cast<float>(random.next() >> 9) - 0x1p22f + 0.5f;
        o.r.push_back(i < 2 ? (i ? -0.0f : 0.0f) : i % 4 == 0 ? half : random.normal(-4, 30, random.coin()));
        o.s.push_back(i == 0 ? 0.0f : random.normal(i % 2 ? -40 : 0, 31, false));
        o.t.push_back(from_bits((random.coin() ? 0x80000000u : 0u) | random.next() >> 9 | 1u));
        o.w.push_back(random.normal(-20, -1, false));
        o.u.push_back(random.next());
        o.v.push_back(random.next());
    }
    return o;
}

/// Calls visit(name, bits of the right result) for each operation and then for each question about denormals, in the order of the list.
template <class Visit>
void each_truth(const Operands& o, std::size_t i, Visit&& visit) {
    using std::ceil, std::floor, std::fma, std::rint, std::sqrt, std::trunc;
    const auto float_to_int = [](float x) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(x)); };
    const auto float_to_uint = [](float x) { return static_cast<std::uint32_t>(x); };
    const auto int_to_float = [](std::uint32_t x) { return static_cast<float>(static_cast<std::int32_t>(x)); };
    const auto uint_to_float = [](std::uint32_t x) { return static_cast<float>(x); };
    const auto mul_hi = [](std::uint32_t x, std::uint32_t y) { return static_cast<std::uint32_t>(std::uint64_t{x} * y >> 32); };
    const auto high_of_product = mul_hi;
    const float a = o.a[i], b = o.b[i], c = o.c[i], r = o.r[i], s = o.s[i], t = o.t[i], w = o.w[i];
    const std::uint32_t u = o.u[i], v = o.v[i];
#define CLVR_FLOAT(name, expression) visit(#name, bits(expression));
#define CLVR_UINT(name, expression) visit(#name, expression);
    CLVR_TRUST_OPERATIONS
    CLVR_TRUST_DENORMALS
#undef CLVR_FLOAT
#undef CLVR_UINT
}

/// Names in the order of the list; the last two are the questions about denormals.
std::vector<std::string> operation_names(const Operands& operands) {
    std::vector<std::string> names;
    each_truth(operands, 0, [&](const char* name, std::uint32_t) { names.emplace_back(name); });
    return names;
}

/// For each operation, how many vectors differ from the truth at this width.
std::vector<std::size_t> differences(Device& device, const Operands& o, std::size_t operations, int width) {
    Buffer results = device.buffer(operations * vectors * sizeof(std::uint32_t), "trust results");
    const Buffer a = device.upload(o.a, "a"), b = device.upload(o.b, "b"), c = device.upload(o.c, "c"), r = device.upload(o.r, "r"),
                 s = device.upload(o.s, "s"), t = device.upload(o.t, "t"), w = device.upload(o.w, "w"), u = device.upload(o.u, "u"),
                 v = device.upload(o.v, "v");
    Kernel kernel = device.kernel("probe/trust", {{"CLVR_WIDTH", std::to_string(width)}});
    const Range global{vectors / static_cast<std::size_t>(width)};
    device.launch(kernel, global, {16}, {}, results, a, b, c, r, s, t, w, u, v, static_cast<cl_uint>(vectors));
    const auto found = device.download<std::uint32_t>(results, operations * vectors);
    std::vector<std::size_t> differ(operations);
    for (std::size_t i = 0; i < vectors; ++i) {
        std::size_t operation = 0;
        each_truth(o, i, [&](const char*, std::uint32_t truth) {
            differ[operation] += found[operation * vectors + i] != truth;
            ++operation;
        });
    }
    return differ;
}

/// What decides the result: the probe itself and the versions of device, driver and platform.
std::string key_of(const DeviceFacts& device) {
    return sha256_hex(
        {trust_version, program_key(device, expand_source("probe/trust.cl", read_kernel_file).text, build_options(device, {}))});
}

std::filesystem::path trust_path(const std::filesystem::path& folder, const std::string& key) { return folder / "trust" / (key + ".json"); }

std::optional<Trust> load_trust(const std::string& key) {
    const auto folder = cache_folder();
    const auto text = folder ? load_file(trust_path(*folder, key)) : std::nullopt;
    if (!text) return std::nullopt;
    try {
        const auto json = nlohmann::json::parse(*text);
        return Trust{json.at("failures"), json.at("denormals_in"), json.at("denormals_out")};
    } catch (const nlohmann::json::exception&) {
        return std::nullopt; // broken: probe again
    }
}

void store(const std::string& key, const Trust& trust) {
    const nlohmann::json json{{"failures", trust.failures}, {"denormals_in", trust.denormals_in}, {"denormals_out", trust.denormals_out}};
    if (const auto folder = cache_folder()) replace_file(trust_path(*folder, key), json.dump(2) + "\n");
}

} // namespace

std::string Trust::text() const { return ok() ? "ok" : fmt::format("fails {}", fmt::join(failures, ", ")); }

Trust probe_trust(const DeviceFacts& facts) {
    const Operands operands = make_operands();
    const std::vector<std::string> names = operation_names(operands);
    const std::size_t required = names.size() - 2;
    const ProbeScope probing;
    Device device = Device::open_untested(facts);
    Trust trust{{}, true, true};
    for (const int width : {1, 16}) {
        const std::vector<std::size_t> differ = differences(device, operands, names.size(), width);
        for (std::size_t i = 0; i < required; ++i)
            if (differ[i]) trust.failures.push_back(fmt::format("{} ({} of {} at width {})", names[i], differ[i], vectors, width));
        trust.denormals_in &= differ[required] == 0;
        trust.denormals_out &= differ[required + 1] == 0;
    }
    return trust;
}

namespace {

/// For a device that CLVR_FAULT makes compute wrong results, nothing is stored, and nothing that was stored is believed.
bool has_faulty_results(const DeviceFacts& device) {
    const auto faults = Faults::of(device);
    return faults && faults->spoils_results();
}

} // namespace

std::optional<Trust> stored_trust(const DeviceFacts& device) { return load_trust(key_of(device)); }

Trust trust_of(const DeviceFacts& device) {
    if (has_faulty_results(device)) return probe_trust(device);
    static std::mutex mutex;
    static std::map<std::string, Trust> known; // by this process, in case nothing can be stored
    const std::lock_guard lock(mutex);
    const std::string key = key_of(device);
    auto found = known.find(key);
    if (found == known.end()) {
        auto trust = load_trust(key);
        if (!trust) store(key, *(trust = probe_trust(device)));
        found = known.emplace(key, *trust).first;
    }
    return found->second;
}

void require_trust(const DeviceFacts& device) {
    const Trust trust = trust_of(device);
    if (trust.ok()) return;
    throw Error(
        ErrorKind::device,
        fmt::format(
            "{} in clvr's trust probe, so its pictures would differ from other devices'; try another --device, or --relaxed to accept that",
            trust.text()),
        device.name);
}

Device open_trusted(const DeviceFacts& facts, bool relaxed) {
    Device device = Device::open_untested(facts);
    if (!relaxed) require_trust(facts);
    return device;
}

} // namespace clvr
