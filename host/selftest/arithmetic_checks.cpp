// The ground: arithmetic, elementary functions, random numbers, memory layout.
#include "host/selftest/check.hpp"
#include "host/selftest/golden_values.hpp"
#include "kernels/shared/struct_fields.h"
#include "runtime/system/hashes.hpp"
#include "runtime/trust/trust.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstring>

namespace clvr::selftest {
namespace {

constexpr int widths[] = {1, 4, 8, 16};
constexpr std::size_t arguments = 4096; // of each function, a multiple of 16

using Floats = std::vector<float>;

/// Floats whose bit patterns lie evenly between those of `low` and `high`, two positive numbers.
Floats bit_range(std::uint32_t low, std::uint32_t high) {
    Floats floats(arguments);
    for (std::size_t i = 0; i < arguments; ++i) {
        const auto bits = static_cast<std::uint32_t>(low + std::uint64_t{high - low} * i / (arguments - 1));
        std::memcpy(&floats[i], &bits, sizeof bits);
    }
    return floats;
}

Floats even_range(double low, double high) {
    Floats floats(arguments);
    for (std::size_t i = 0; i < arguments; ++i)
        floats[i] = static_cast<float>(low + (high - low) * static_cast<double>(i) / (arguments - 1.0));
    return floats;
}

/// Arguments of function f of math_values.cl over all of its range; the second ones matter to atan2 alone.
std::pair<Floats, Floats> function_arguments(std::size_t f) {
    const Floats ordinates = even_range(-3, 5);
    Floats abscissas = bit_range(0x38000000u, 0x43000000u); // 2^-15 .. 2^7
    for (std::size_t i = 0; i < arguments; i += 2) abscissas[i] = -abscissas[i];
    const Floats first[] = {bit_range(0x00800000u, 0x7f000000u), even_range(-100, 90), even_range(-40, 24), ordinates, even_range(-1, 1)};
    return {first[f], abscissas};
}

std::string words(const std::array<std::uint32_t, 4>& block) {
    return fmt::format("{:08x} {:08x} {:08x} {:08x}", block[0], block[1], block[2], block[3]);
}

} // namespace

Outcome check_trust(Device& device) {
    const Trust trust = probe_trust(device.facts());
    const auto kept = [](bool yes) { return yes ? "kept" : "flushed"; };
    return {trust.ok(), "ok",
            fmt::format("{}; denormals in {}, out {}", trust.text(), kept(trust.denormals_in), kept(trust.denormals_out))};
}

Outcome check_functions(Device& device) {
    std::string expected, found;
    bool ok = true;
    for (std::size_t f = 0; f < golden_functions.size(); ++f) {
        const auto& [name, hash] = golden_functions[f];
        const auto [a, b] = function_arguments(f);
        const Buffer in_a = device.upload(a, "a"), in_b = device.upload(b, "b");
        std::string differing = hash;
        for (const int width : widths) {
            Kernel kernel = device.kernel("selftest/math_values", {{"CLVR_WIDTH", std::to_string(width)}});
            const Buffer first = device.buffer(4 * arguments, "first"), second = device.buffer(4 * arguments, "second");
            const auto packets = static_cast<std::uint32_t>(arguments) / static_cast<std::uint32_t>(width);
            device.launch(kernel, {packets}, kernel.group(64), {}, in_a, in_b, first, second, packets, static_cast<int>(f));
            const auto bits = [&](const Buffer& values) {
                const auto v = device.download<unsigned char>(values, 4 * arguments);
                return std::string(v.begin(), v.end());
            };
            const std::string got = sha256_hex({bits(first), bits(second)});
            if (got != hash) differing = fmt::format("{} at width {}", got, width), ok = false;
        }
        expected += fmt::format("{}{} {}", f ? ", " : "", name, hash);
        found += fmt::format("{}{} {}", f ? ", " : "", name, differing);
    }
    return {ok, expected, found};
}

Outcome check_random(Device& device) {
    for (const KnownRandom& known : published_random)
        for (const int width : widths) {
            Kernel kernel = device.kernel("selftest/random_blocks", {{"CLVR_WIDTH", std::to_string(width)}});
            constexpr std::size_t n = 16;
            std::vector<Buffer> in, out;
            for (int k = 0; k < 4; ++k) {
                in.push_back(device.upload(std::vector<std::uint32_t>(n, known.counter[k]), "counters"));
                out.push_back(device.buffer(4 * n, "blocks"));
            }
            const Buffer number = device.buffer(4 * n, "numbers");
            const auto packets = static_cast<std::uint32_t>(n) / static_cast<std::uint32_t>(width);
            device.launch(kernel, {packets}, {1}, {}, in[0], in[1], in[2], in[3], known.key[0], known.key[1], out[0], out[1], out[2],
                          out[3], number, packets);
            std::vector<std::uint32_t> planes[4];
            for (int k = 0; k < 4; ++k) planes[k] = device.download<std::uint32_t>(out[k], n);
            const auto numbers = device.download<float>(number, n);
            for (std::size_t i = 0; i < n; ++i) {
                const std::array<std::uint32_t, 4> block{planes[0][i], planes[1][i], planes[2][i], planes[3][i]};
                const float wanted = static_cast<float>(known.block[0] >> 9) * 0x1p-23f;
                if (block != known.block || numbers[i] != wanted)
                    return {false, fmt::format("{} and {}", words(known.block), wanted),
                            fmt::format("{} and {} at width {}", words(block), numbers[i], width)};
            }
        }
    const std::string all = fmt::format("{} published blocks at widths 1, 4, 8, 16", std::size(published_random));
    return {true, all, all};
}

Outcome check_layout(Device& device) {
    struct Entry {
        std::string name;
        std::size_t value;
    };
    const std::vector<Entry> entries{
#define CLVR_STRUCT(type) {"size of " #type, sizeof(shared::type)},
#define CLVR_FIELD(type, field) {#type "::" #field, offsetof(shared::type, field)},
        CLVR_EACH_STRUCT_AND_FIELD
#undef CLVR_STRUCT
#undef CLVR_FIELD
    };
    const Buffer to = device.buffer(4 * entries.size(), "layout"), base = device.buffer(4096, "structs");
    Kernel kernel = device.kernel("selftest/struct_layout");
    device.launch(kernel, {1}, {1}, {}, to, base);
    const auto found = device.download<std::uint32_t>(to, entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (found[i] != entries[i].value)
            return {false, fmt::format("{} {}", entries[i].name, entries[i].value), fmt::format("{}", found[i])};
    const std::string all = fmt::format("{} sizes and offsets", entries.size());
    return {true, all, all};
}

} // namespace clvr::selftest
