// A folder in which experiments are run.
#pragma once
#include "tests/cli/program.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace clvr {

class ExperimentFolder : public testing::Test {
protected:
    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder.path() / name); }
    Outcome run(const std::vector<std::string>& words) const { return Child(words, {}, folder.path()).wait(); }
    std::string text(const std::string& name) const {
        std::ifstream in(folder.path() / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// Every file below a folder, by its path there.
    std::map<std::string, std::string> contents(const std::string& name) const {
        std::map<std::string, std::string> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path() / name))
            if (entry.is_regular_file())
                all[std::filesystem::relative(entry.path(), folder.path() / name).string()] = text(entry.path().string());
        return all;
    }
    /// Less the files that say how long it took.
    static std::map<std::string, std::string> untimed(std::map<std::string, std::string> files) {
        for (const char* name : {"stages.json", "results.json", "results.md"}) files.erase(name);
        return files;
    }

    TemporaryFolder folder;
};

} // namespace clvr
