// Frames and folders for the tests of picture files.
#pragma once
#include "host/frame/frame.hpp"
#include "runtime/error.hpp"
#include "tests/io/folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace clvr::test {

inline std::string bytes_of(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Writes a file. An old one is removed first: ext4 brings a file that is truncated and written again to disk at once, which takes 10 ms.
inline void put(const std::string& path, const std::string& bytes) {
    std::filesystem::remove(path);
    std::ofstream(path, std::ios::binary) << bytes;
}

/// Noise in the named channels, in -1..2.
inline Frame noise(int width, int height, const std::vector<std::string>& channels) {
    Frame frame;
    frame.width = width;
    frame.height = height;
    std::mt19937 random(7);
    for (const auto& name : channels)
        for (float& x : frame.channel(name)) x = static_cast<float>(random() % 3000) / 1000 - 1;
    return frame;
}

/// The Error that `f` throws; fails the test when it throws none, or one with a line break or without a place.
template <class F>
Error error_of(F&& f) {
    try {
        f();
    } catch (const Error& e) {
        EXPECT_EQ(e.line().find('\n'), std::string::npos) << e.line();
        EXPECT_FALSE(e.where().empty()) << e.line();
        return e;
    }
    ADD_FAILURE() << "no Error";
    return Error(ErrorKind::internal, "no error", "test");
}

} // namespace clvr::test
