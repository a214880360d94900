// The progress of something in stages.
#pragma once
#include "host/cli/progress_bar.hpp"

#include <optional>
#include <string>

namespace clvr {

/// A progress bar a stage; where there is no terminal, a line a stage on stderr.
class StageDisplay {
public:
    void update(const std::string& stage, double done, const std::string& note);
    void end() { bar_.reset(); }

private:
    std::string stage_;
    std::optional<ProgressBar> bar_;
};

} // namespace clvr
