// A home of their own for the programs that tests run.
#pragma once
#include "tests/cli/program.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace clvr {

/// Oclgrind as a driver.
inline constexpr const char* oclgrind = "/usr/lib/oclgrind/liboclgrind-rt-icd.so";

/// Where PoCL keeps kernels for this user, so that programs with another home need not compile them again.
inline std::string pocl_cache() {
    const auto variable = [](const char* name) { return std::string(std::getenv(name) ? std::getenv(name) : ""); };
    if (!variable("POCL_CACHE_DIR").empty()) return variable("POCL_CACHE_DIR");
    return (variable("XDG_CACHE_HOME").empty() ? variable("HOME") + "/.cache" : variable("XDG_CACHE_HOME")) + "/pocl/kcache";
}

/// Runs programs with a home of their own.
class Program : public testing::Test {
protected:
    TemporaryFolder home;

    Child start(const std::vector<std::string>& arguments, Environment environment = {}, const std::function<void()>& prepare = {}) const {
        const Environment usual{{"HOME", home.path().string()},
                                {"XDG_CACHE_HOME", std::nullopt},
                                {"XDG_CONFIG_HOME", std::nullopt},
                                {"CLVR_DEVICE", std::nullopt},
                                {"POCL_CACHE_DIR", pocl_cache()}};
        environment.insert(usual.begin(), usual.end());
        return {arguments, environment, home.path(), prepare};
    }
    Outcome run(const std::vector<std::string>& arguments, const Environment& environment = {},
                const std::function<void()>& prepare = {}) const {
        return start(arguments, environment, prepare).wait();
    }

    /// A volume of 16x16x16 bytes.
    std::string ball() const {
        std::string voxels(16 * 16 * 16, '\0');
        for (int i = 0; i < 16 * 16 * 16; ++i) {
            const int x = i % 16 - 8, y = i / 16 % 16 - 8, z = i / 256 - 8;
            voxels[static_cast<std::size_t>(i)] = static_cast<char>(std::max(0, 120 - 2 * (x * x + y * y + z * z)));
        }
        home.write("ball_16x16x16_uint8.raw", voxels);
        return (home.path() / "ball_16x16x16_uint8.raw").string();
    }

    std::vector<std::filesystem::path> files(const std::string& folder) const {
        std::vector<std::filesystem::path> result;
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator(home.path() / folder, none)) result.push_back(entry.path());
        return result;
    }
};

inline std::ptrdiff_t line_count(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

} // namespace clvr
