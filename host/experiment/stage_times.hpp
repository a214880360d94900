// How long the stages of something resumable took, over all its runs.
#pragma once
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace clvr {

/// Seconds by stage, kept in a JSON file that is written after each.
class StageTimes {
public:
    /// Reads the file where there is one. Throws Error{input}.
    explicit StageTimes(std::string path);

    /// Runs f and adds the time that it took to the stage, also when f throws (an interruption).
    template <class F>
    auto time(const std::string& stage, F&& f) {
        const Adding adding{*this, stage, std::chrono::steady_clock::now()};
        return f();
    }
    /// Notes that a stage is complete.
    void finish(const std::string& stage);
    bool finished(const std::string& stage) const;
    double seconds(const std::string& stage) const;
    /// In the order of their first run.
    const std::vector<std::pair<std::string, double>>& all() const { return seconds_; }

private:
    struct Adding {
        StageTimes& times;
        const std::string& stage;
        std::chrono::steady_clock::time_point begin;
        ~Adding();
    };
    std::string path_;
    std::vector<std::pair<std::string, double>> seconds_;
    std::vector<std::string> finished_;

    void add(const std::string& stage, double seconds);
    void write() const;
};

} // namespace clvr
