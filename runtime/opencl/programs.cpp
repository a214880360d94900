#include "runtime/opencl/programs.hpp"

#include <algorithm>

namespace clvr {

Programs::~Programs() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void Programs::prepare(const Key& key) {
    {
        const std::lock_guard lock(mutex_);
        if (!entries_.try_emplace(key).second) return;
        waiting_.push_back(key);
        if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    }
    changed_.notify_all();
}

cl::Program Programs::get(const Key& key) {
    std::unique_lock lock(mutex_);
    Entry& entry = entries_[key];
    changed_.wait(lock, [&] { return entry.program || entry.failure || !busy_; });
    if (!entry.program && !entry.failure) build(key, lock);
    if (entry.program) return *entry.program;
    std::rethrow_exception(std::exchange(entry.failure, nullptr)); // and the next get() tries again
}

/// Builds one program; the lock is open meanwhile.
void Programs::build(const Key& key, std::unique_lock<std::mutex>& lock) {
    Entry& entry = entries_[key];
    waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), key), waiting_.end());
    busy_ = true;
    lock.unlock();
    std::optional<cl::Program> program;
    std::exception_ptr failure;
    try {
        program = build_(key);
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    entry.program = std::move(program);
    entry.failure = failure;
    busy_ = false;
    changed_.notify_all();
}

void Programs::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return ending_ || (!waiting_.empty() && !busy_); });
        if (ending_) return;
        build(Key(waiting_.front()), lock);
    }
}

} // namespace clvr
