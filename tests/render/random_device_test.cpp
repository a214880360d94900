// The random numbers: Philox against published vectors and a plain implementation, at every packet width; their conversion to floats.
#include "host/selftest/golden_values.hpp"
#include "tests/reference/random.hpp"
#include "tests/render/scenes.hpp"

#include <random>

namespace clvr::testing {
namespace {

using Block = std::array<std::uint32_t, 4>;
using Key = std::array<std::uint32_t, 2>;

struct Blocks {
    std::vector<Block> block;
    std::vector<float> number; ///< v_uniform of each block's first word
};

/// The blocks of a multiple of 16 counters.
Blocks device_blocks(Device& device, int width, const std::vector<Block>& counters, const Key& key) {
    Kernel kernel = device.kernel("selftest/random_blocks", {{"CLVR_WIDTH", std::to_string(width)}});
    const std::size_t n = counters.size();
    std::vector<Buffer> in, out;
    for (int k = 0; k < 4; ++k) {
        std::vector<std::uint32_t> plane(n);
        for (std::size_t i = 0; i < n; ++i) plane[i] = counters[i][k];
        in.push_back(device.upload(plane, "counters"));
        out.push_back(device.buffer(4 * n, "blocks"));
    }
    const Buffer number = device.buffer(4 * n, "numbers");
    const auto packets = static_cast<std::uint32_t>(n / width);
    device.launch(kernel, {packets}, {64}, {}, in[0], in[1], in[2], in[3], key[0], key[1], out[0], out[1], out[2], out[3], number, packets);
    Blocks result{std::vector<Block>(n), device.download<float>(number, n)};
    for (int k = 0; k < 4; ++k) {
        const auto plane = device.download<std::uint32_t>(out[k], n);
        for (std::size_t i = 0; i < n; ++i) result.block[i][k] = plane[i];
    }
    return result;
}

TEST(Philox, GivesThePublishedVectors) {
    Device device = shared_device();
    for (const KnownRandom& known : published_random) {
        EXPECT_EQ(reference::philox(known.counter, known.key), known.block);
        for (int width : {1, 4, 8, 16})
            for (const Block& b : device_blocks(device, width, std::vector<Block>(16, known.counter), known.key).block)
                EXPECT_EQ(b, known.block) << "width " << width;
    }
}

TEST(Philox, IsThePlainImplementationOnAnyCounter) {
    Device device = shared_device();
    std::mt19937 random(5);
    std::vector<Block> counters(1 << 14);
    for (Block& c : counters)
        for (auto& word : c) word = random();
    const Key key{static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())};
    for (int width : {1, 4, 8, 16}) {
        const Blocks found = device_blocks(device, width, counters, key);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < counters.size(); ++i) {
            wrong += found.block[i] != reference::philox(counters[i], key);
            wrong += found.number[i] != static_cast<float>(found.block[i][0] >> 9) * 0x1p-23f;
        }
        EXPECT_EQ(wrong, 0u) << "width " << width;
    }
}

/// The numbers of neighbouring pixels, samples, blocks and streams, as the tracer counts them: uniform in 0..1, uncorrelated.
TEST(Uniform, HasFlatHistogramAndNoNeighbourCorrelation) {
    Device device = shared_device();
    constexpr std::size_t n = 1 << 20;
    for (int axis = 0; axis < 4; ++axis) {
        std::vector<Block> counters(n, Block{7, 3, 1, 4});
        for (std::size_t i = 0; i < n; ++i) counters[i][axis] = static_cast<std::uint32_t>(i);
        const std::vector<float> u = device_blocks(device, 16, counters, {12345, 678}).number;
        constexpr int bins = 256;
        std::vector<double> count(bins, 0);
        double sum = 0, squares = 0, neighbours = 0;
        for (std::size_t i = 0; i < n; ++i) {
            ASSERT_TRUE(u[i] >= 0 && u[i] < 1);
            ++count[static_cast<int>(u[i] * bins)];
            sum += u[i] - 0.5;
            squares += (u[i] - 0.5) * (u[i] - 0.5);
            if (i) neighbours += (u[i] - 0.5) * (u[i - 1] - 0.5);
        }
        double chi2 = 0;
        for (double c : count) chi2 += (c - n / 256.0) * (c - n / 256.0) / (n / 256.0);
        EXPECT_NEAR(chi2, bins - 1, 4 * std::sqrt(2.0 * (bins - 1))) << "axis " << axis;
        EXPECT_NEAR(sum / n, 0, 4 * std::sqrt(1.0 / 12 / n)) << "axis " << axis;
        EXPECT_NEAR(squares / n, 1.0 / 12, 4 * std::sqrt(1.0 / 180 / n)) << "axis " << axis;
        EXPECT_NEAR(neighbours / n, 0, 4 * std::sqrt(1.0 / 144 / n)) << "axis " << axis;
    }
}

} // namespace
} // namespace clvr::testing
