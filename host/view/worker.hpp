// Work that neither the network nor the render thread should wait for.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace clvr::view {

/// One thread that does what it is given, in order.
class Worker {
public:
    Worker() : thread_([this] { work(); }) {}
    ~Worker() { stop(); }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Must not throw. Once stopped, nothing is taken any more.
    void add(std::function<void()> task);
    /// Drops what has not begun, and waits for what has.
    void stop();

private:
    std::mutex mutex_; // of what follows
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    bool stopped_ = false;
    std::thread thread_;

    void work();
};

/// The same for what is soon out of date: only the newest value waits.
template <class T>
class NewestWorker {
public:
    explicit NewestWorker(std::function<void(const T&)> use) : use_(std::move(use)) {}
    void put(T value) {
        const std::lock_guard lock(mutex_);
        newest_ = std::move(value);
        if (waits_) return;
        waits_ = true;
        worker_.add([this] { use_(take()); });
    }
    void stop() { worker_.stop(); }

private:
    std::function<void(const T&)> use_;
    std::mutex mutex_; // of what follows
    T newest_{};
    bool waits_ = false;
    Worker worker_;

    T take() {
        const std::lock_guard lock(mutex_);
        waits_ = false;
        return std::exchange(newest_, T{});
    }
};

} // namespace clvr::view
