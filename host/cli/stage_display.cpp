#include "host/cli/stage_display.hpp"

#include <spdlog/spdlog.h>

namespace clvr {

void StageDisplay::update(const std::string& stage, double done, const std::string& note) {
    if (stage != stage_) {
        stage_ = stage;
        bar_.emplace(stage, false);
        spdlog::info("{}", stage);
    }
    bar_->update(done, note);
}

} // namespace clvr
