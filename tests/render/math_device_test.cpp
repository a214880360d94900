// The elementary functions of kernels/lib/math.clh against the C library in double, and the same bits at every packet width.
#include "tests/render/scenes.hpp"

namespace clvr::testing {
namespace {

enum MathFunction { log_of, exp_of, sincos_of, atan2_of, acos_of };
using Floats = std::vector<float>;

struct Values {
    Floats first, second;
};

/// b as long as a, a multiple of 16.
Values evaluate(Device& device, int width, MathFunction function, const Floats& a, const Floats& b) {
    Kernel kernel = device.kernel("selftest/math_values", {{"CLVR_WIDTH", std::to_string(width)}});
    const Buffer in_a = device.upload(a, "a"), in_b = device.upload(b, "b");
    const Buffer first = device.buffer(4 * a.size(), "first"), second = device.buffer(4 * a.size(), "second");
    const auto packets = static_cast<std::uint32_t>(a.size() / width);
    device.launch(kernel, {packets}, {64}, {}, in_a, in_b, first, second, packets, static_cast<int>(function));
    return {device.download<float>(first, a.size()), device.download<float>(second, a.size())};
}

float from_bits(std::uint32_t bits) {
    float f;
    std::memcpy(&f, &bits, 4);
    return f;
}

/// 2^20 floats spread evenly over the bit patterns from low to high (both of one sign), the ends among them.
Floats bit_range(float low, float high) {
    std::uint32_t a, b;
    std::memcpy(&a, &low, 4), std::memcpy(&b, &high, 4);
    constexpr std::size_t count = 1 << 20;
    Floats floats(count);
    for (std::size_t i = 0; i < count; ++i)
        floats[i] =
            from_bits(static_cast<std::uint32_t>(a + (static_cast<std::int64_t>(b) - a) * static_cast<std::int64_t>(i) / (count - 1.0)));
    return floats;
}

/// 2^20 evenly spaced floats.
Floats even_range(double low, double high) {
    constexpr std::size_t count = 1 << 20;
    Floats floats(count);
    for (std::size_t i = 0; i < count; ++i) floats[i] = static_cast<float>(low + (high - low) * static_cast<double>(i) / (count - 1.0));
    return floats;
}

double ulp(double x) { return std::ldexp(1.0, std::max(std::ilogb(x), -126) - 23); }

/// Largest error over all arguments, in ulps of the true value or absolute.
template <class F>
double largest_error(const Floats& found, const Floats& a, const Floats& b, bool in_ulps, F&& truth) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double t = truth(static_cast<double>(a[i]), static_cast<double>(b[i]));
        const double error = std::abs(found[i] - t) / (in_ulps ? ulp(t) : 1);
        if (!(error <= worst)) worst = error; // NaN stays
    }
    return worst;
}

struct Math : ::testing::Test {
    Device device = shared_device();
    double error(MathFunction f, const Floats& a, const Floats& b, bool in_ulps, double (*truth)(double, double), bool second = false) {
        const Values v = evaluate(device, 16, f, a, b);
        return largest_error(second ? v.second : v.first, a, b, in_ulps, truth);
    }
};

TEST_F(Math, Log) {
    const auto truth = [](double x, double) { return std::log(x); };
    for (const Floats& x : {bit_range(0x1p-126f, 0x1p127f), even_range(0x1p-23, 2)}) EXPECT_LE(error(log_of, x, x, true, truth), 0.9);
    const Floats ones(16, 1.0f);
    EXPECT_EQ(evaluate(device, 16, log_of, ones, ones).first, Floats(16, 0.0f));
}

TEST_F(Math, Exp) {
    const auto truth = [](double x, double) { return std::exp(std::min(x, 88.0)); };
    for (const Floats& x : {even_range(-87.3365, 90), bit_range(-1e-30f, -87.3365f), bit_range(1e-30f, 100)})
        EXPECT_LE(error(exp_of, x, x, true, truth), 1.1);
    Floats x(16, 0.0f);
    x[0] = -87.34f, x[1] = -1e30f, x[2] = -88, x[3] = -103.9f;
    const Floats y = evaluate(device, 16, exp_of, x, x).first;
    for (int i = 0; i < 16; ++i) EXPECT_EQ(y[i], i < 4 ? 0.0f : 1.0f) << x[i];
}

TEST_F(Math, SineAndCosineOfTurns) {
    const auto sine = [](double x, double) { return std::sin(2 * pi * (x - std::rint(x))); };
    const auto cosine = [](double x, double) { return std::cos(2 * pi * (x - std::rint(x))); };
    for (const Floats& x : {even_range(-2, 2), even_range(-1048576, 1048576), bit_range(1e-30f, 1)}) {
        EXPECT_LE(error(sincos_of, x, x, false, sine), 8.6e-8);
        EXPECT_LE(error(sincos_of, x, x, false, cosine, true), 8.6e-8);
    }
}

TEST_F(Math, Atan2InTurns) {
    const auto truth = [](double y, double x) {
        const double t = std::atan2(y, x) / (2 * pi);
        return t < 0 ? t + 1 : t;
    };
    Floats y(1 << 20), x(1 << 20);
    for (std::size_t i = 0; i < y.size(); ++i) {
        const double turn = 2 * pi * static_cast<double>(i) / static_cast<double>(y.size()),
                     r = std::exp2(static_cast<double>(i % 61) - 30.0);
        y[i] = static_cast<float>(r * std::sin(turn)), x[i] = static_cast<float>(r * std::cos(turn));
    }
    EXPECT_LE(error(atan2_of, y, x, false, truth), 3e-8);
    y.assign(16, 0), x.assign(16, 0);
    x[1] = 1, x[2] = -1, y[3] = 1, y[4] = -1, y[5] = -0.0f, x[5] = -0.0f, y[6] = x[6] = 3, y[7] = 3, x[7] = -3;
    const Floats t = evaluate(device, 16, atan2_of, y, x).first;
    const Floats expected{0, 0, 0.5f, 0.25f, 0.75f, 0, 0.125f, 0.375f};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(t[i], expected[i], 3e-8) << i;
}

TEST_F(Math, AcosInHalfTurns) {
    const auto truth = [](double c, double) { return std::acos(c) / pi; };
    const Floats c = even_range(-1, 1);
    EXPECT_LE(error(acos_of, c, c, false, truth), 8e-8);
}

TEST_F(Math, SameBitsAtEveryWidth) {
    const Floats a = even_range(-2, 2), b = bit_range(-1e-3f, -1e3f), positive = bit_range(0x1p-126f, 0x1p127f), low = even_range(-100, 90);
    for (const auto& [function, x] : {std::pair(log_of, &positive), {exp_of, &low}, {sincos_of, &a}, {atan2_of, &a}, {acos_of, &a}}) {
        const Values one = evaluate(device, 1, function, *x, b);
        for (int width : {4, 8, 16}) {
            const Values wide = evaluate(device, width, function, *x, b);
            EXPECT_EQ(std::memcmp(one.first.data(), wide.first.data(), 4 * a.size()), 0)
                << "function " << function << " at width " << width;
            EXPECT_EQ(std::memcmp(one.second.data(), wide.second.data(), 4 * a.size()), 0)
                << "function " << function << " at width " << width;
        }
    }
}

} // namespace
} // namespace clvr::testing
