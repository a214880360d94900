// What clvr warns of while a test runs.
#pragma once
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>

namespace clvr {

/// Collects the warnings, a line each, instead of printing them.
class Warnings {
public:
    Warnings() : before_(spdlog::default_logger()) {
        auto logger = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_));
        logger->set_pattern("%v");
        spdlog::set_default_logger(std::move(logger));
    }
    ~Warnings() { spdlog::set_default_logger(before_); }
    Warnings(const Warnings&) = delete;
    Warnings& operator=(const Warnings&) = delete;
    std::string text() const { return text_.str(); }
    std::ptrdiff_t lines() const {
        const std::string all = text();
        return std::count(all.begin(), all.end(), '\n');
    }

private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::logger> before_;
};

} // namespace clvr
