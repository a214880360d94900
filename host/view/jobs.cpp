#include "host/view/jobs.hpp"
#include "host/view/limits.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

namespace clvr::view {

struct Jobs::Kept {
    Job job;
    std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
    std::chrono::steady_clock::time_point told{};

    ~Kept() {
        std::error_code ignored;
        if (!job.path.empty()) std::filesystem::remove(job.path, ignored);
    }
};

Jobs::~Jobs() = default;

Job Jobs::begin(Product what, const std::string& name) {
    const std::lock_guard lock(mutex_);
    if (one_is_unfinished()) throw Error(ErrorKind::usage, "Another save is not finished yet. Wait for it, or cancel it.");
    if (jobs_.size() >= most_jobs) jobs_.erase(jobs_.begin());
    auto kept = std::make_shared<Kept>();
    kept->job.id = std::to_string(++last_), kept->job.what = what, kept->job.name = name;
    jobs_.push_back(kept);
    return kept->job;
}

std::shared_ptr<Jobs::Kept> Jobs::find(const std::string& id) const {
    const auto found = std::find_if(jobs_.begin(), jobs_.end(), [&](const auto& kept) { return kept->job.id == id; });
    return found == jobs_.end() ? nullptr : *found;
}

template <class F>
void Jobs::change(const std::string& id, bool always, F&& f) {
    constexpr auto pause = std::chrono::milliseconds(100);
    Job told;
    {
        const std::lock_guard lock(mutex_);
        const auto kept = find(id);
        if (!kept || kept->job.finished()) return;
        f(kept->job);
        const auto now = std::chrono::steady_clock::now();
        if (!always && now - kept->told < pause) return;
        kept->told = now;
        told = kept->job;
    }
    changed_(told);
}

void Jobs::progress(const std::string& id, double share, int samples) {
    change(id, false, [&](Job& job) { job.state = JobState::running, job.progress = share, job.samples = samples; });
}
void Jobs::done(const std::string& id, const std::string& path) {
    change(id, true, [&](Job& job) { job.state = JobState::done, job.progress = 1, job.path = path; });
}
void Jobs::failed(const std::string& id, const std::string& message) {
    change(id, true, [&](Job& job) { job.state = JobState::failed, job.message = message; });
}
void Jobs::cancelled(const std::string& id) {
    change(id, true, [](Job& job) { job.state = JobState::cancelled; });
}

void Jobs::cancel(const std::string& id) {
    const std::lock_guard lock(mutex_);
    if (const auto kept = find(id)) *kept->cancelled = true;
}

void Jobs::cancel_all() {
    const std::lock_guard lock(mutex_);
    for (const auto& kept : jobs_) *kept->cancelled = true;
}

std::shared_ptr<const std::atomic<bool>> Jobs::cancellation(const std::string& id) const {
    const std::lock_guard lock(mutex_);
    const auto kept = find(id);
    return kept ? kept->cancelled : std::make_shared<std::atomic<bool>>(true);
}

std::vector<Job> Jobs::all() const {
    const std::lock_guard lock(mutex_);
    std::vector<Job> all;
    for (const auto& kept : jobs_) all.push_back(kept->job);
    return all;
}

bool Jobs::busy() const {
    const std::lock_guard lock(mutex_);
    return one_is_unfinished();
}

bool Jobs::one_is_unfinished() const {
    return std::any_of(jobs_.begin(), jobs_.end(), [](const auto& kept) { return !kept->job.finished(); });
}

std::string Jobs::file(const std::string& id, const std::string& name) const {
    const std::lock_guard lock(mutex_);
    const auto kept = find(id);
    return kept && kept->job.name == name ? kept->job.path : std::string();
}

} // namespace clvr::view
