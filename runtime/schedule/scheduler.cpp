#include "runtime/schedule/scheduler.hpp"

#include "runtime/drivers/check.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <thread>

namespace clvr {
namespace {

using Clock = std::chrono::steady_clock;

/// How long a device that leaves the rest to others sleeps before it looks whether they keep what was expected of them.
constexpr std::chrono::milliseconds patience{5};

double seconds_between(Clock::time_point from, Clock::time_point to) { return std::chrono::duration<double>(to - from).count(); }

struct Chunk {
    std::uint32_t first, count;
};

/// The numbers that nobody has done yet, and what each device works on.
class Queue {
public:
    Queue(std::uint32_t total, double cost, const std::vector<Scheduler::ChunkSize>& chunk_sizes, std::vector<Scheduler::Speed>& speeds,
          const std::vector<std::size_t>& devices)
        : total_(total), rest_(total), cost_(cost), chunk_sizes_(chunk_sizes), speeds_(speeds), workers_(chunk_sizes.size()) {
        if (total > 0) rest_chunks_.push_back({0, total});
        for (const std::size_t d : devices) workers_[d].present = true;
    }

    /// The device's next chunk; waits while others might still give theirs back. Nothing when all is done or the work has ended.
    std::optional<Chunk> take(std::size_t device) {
        std::unique_lock lock(mutex_);
        for (;;) {
            if (failure_ || (rest_ == 0 && busy() == 0)) return std::nullopt;
            if (rest_ > 0) {
                const std::uint32_t count = chunk_size(device);
                if (!another_ends_sooner(device, count)) return cut(device, count);
            }
            changed_.wait_for(lock, patience);
        }
    }

    void done(std::size_t device, const Chunk& chunk) {
        const std::lock_guard lock(mutex_);
        Worker& worker = workers_[device];
        speeds_[device].add(chunk.count * cost_ / std::max(1e-9, seconds_between(worker.since, Clock::now())));
        worker.busy = false;
        changed_.notify_all();
    }

    /// The device has failed; its chunk goes back. `drop` may throw, which ends the work.
    template <class Drop>
    void leave(std::size_t device, const Chunk& chunk, Drop&& drop) {
        const std::lock_guard lock(mutex_);
        workers_[device].busy = workers_[device].present = false;
        rest_chunks_.push_back(chunk);
        rest_ += chunk.count;
        try {
            drop();
        } catch (...) {
            if (!failure_) failure_ = std::current_exception();
        }
        changed_.notify_all();
    }

    void end(std::exception_ptr failure) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::move(failure);
        changed_.notify_all();
    }

    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    struct Worker {
        bool present = false, busy = false;
        Clock::time_point since;
        double expected_s = 0; // of its chunk; 0: unknown
    };
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Chunk> rest_chunks_; // that nobody has; taken from the front of the last one
    std::uint32_t total_, rest_;
    double cost_;
    const std::vector<Scheduler::ChunkSize>& chunk_sizes_;
    std::vector<Scheduler::Speed>& speeds_;
    std::vector<Worker> workers_;
    std::exception_ptr failure_;

    std::size_t busy() const {
        return static_cast<std::size_t>(std::count_if(workers_.begin(), workers_.end(), [](const Worker& w) { return w.busy; }));
    }

    std::uint32_t chunk_size(std::size_t device) const {
        const Scheduler::ChunkSize& p = chunk_sizes_[device];
        double present = 0, known = 0, sum = 0;
        for (std::size_t d = 0; d < workers_.size(); ++d)
            if (workers_[d].present) present += 1, known += speeds_[d].rate > 0, sum += speeds_[d].rate;
        double share = 1; // of the rest
        if (present > 1) {
            const double own = speeds_[device].rate;
            share = own > 0 ? 0.5 * own / (sum / known * present) : 0.25 / present * total_ / rest_;
        }
        const double wanted = std::min<double>(p.most, share * rest_);
        const std::uint32_t least = std::max(1u, p.least), count = std::max(1u, static_cast<std::uint32_t>(wanted) / least) * least;
        const std::uint32_t whole = rest_chunks_.back().count;
        return count >= whole || (whole - count < least && whole <= p.most) ? whole : count; // leaves no crumb
    }

    /// Whether another device will have done all of the rest before this one has done so many. This cannot hold of two devices at once: the
    /// one that would end soonest takes the rest.
    bool another_ends_sooner(std::size_t device, std::uint32_t count) const {
        if (speeds_[device].rate <= 0) return false;
        const double own_s = count * cost_ / speeds_[device].rate;
        const auto now = Clock::now();
        for (std::size_t d = 0; d < workers_.size(); ++d) {
            const Worker& w = workers_[d];
            if (d == device || !w.present || speeds_[d].rate <= 0) continue;
            double wait_s = 0;
            if (w.busy) { // one that is late is taken to need as long again as it is late
                wait_s = std::abs(w.expected_s - seconds_between(w.since, now));
            }
            if (wait_s + rest_ * cost_ / speeds_[d].rate < own_s) return true;
        }
        return false;
    }

    Chunk cut(std::size_t device, std::uint32_t count) {
        Chunk& from = rest_chunks_.back();
        const Chunk chunk{from.first, count};
        from.first += count, from.count -= count, rest_ -= count;
        if (from.count == 0) rest_chunks_.pop_back();
        const double rate = speeds_[device].rate;
        workers_[device].busy = true;
        workers_[device].since = Clock::now();
        workers_[device].expected_s = rate > 0 ? count * cost_ / rate : 0;
        return chunk;
    }
};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

} // namespace

std::string display_name(const DeviceFacts& device) {
    const std::string root = fmt::format("device {} \"{}\"", device.index, device.name);
    return device.sub_devices ? fmt::format("part {}/{} of {}", device.sub_device + 1, device.sub_devices, root) : root;
}

bool is_same(Device a, Device b) { return a.queue()() == b.queue()(); }

void copy(Device& device, const Buffer& from, Buffer& to, std::size_t bytes, std::size_t from_offset, std::size_t to_offset) {
    if (from_offset > from.bytes() || bytes > from.bytes() - from_offset || to_offset > to.bytes() || bytes > to.bytes() - to_offset)
        throw Error(ErrorKind::internal, fmt::format("a copy of {} bytes leaves a buffer", bytes), device.facts().name);
    cl_check("copying on " + device.facts().name,
             [&] { device.queue().enqueueCopyBuffer(from.handle(), to.handle(), from_offset, to_offset, bytes); });
}

bool is_device_failure(const Error& error) { return error.kind() == ErrorKind::device || error.kind() == ErrorKind::device_memory; }

void Scheduler::Speed::add(double measured) {
    // The first chunk pays for what drivers do at a kernel's first launch.
    rate = chunks < 2 ? measured : 0.5 * (rate + measured);
    ++chunks;
}

Scheduler::Scheduler(const std::vector<Device>& devices) : left_(devices.size(), true) {
    for (const Device& d : devices) names_.push_back(display_name(d.facts()));
}

std::vector<std::size_t> Scheduler::left() const {
    std::vector<std::size_t> devices;
    for (std::size_t d = 0; d < left_.size(); ++d)
        if (left_[d]) devices.push_back(d);
    if (devices.empty()) throw Error(ErrorKind::device, "no device is left: all have failed");
    return devices;
}

double Scheduler::speed(const std::string& label, std::size_t device) const {
    const auto found = speeds_.find(label);
    return found == speeds_.end() ? 0 : found->second.at(device).rate;
}

void Scheduler::drop(std::size_t device, const Error& error) {
    left_[device] = false;
    if (std::find(left_.begin(), left_.end(), true) == left_.end()) throw Error(error);
    spdlog::warn("{} failed and is left out, the other devices do its work: {}", names_[device], first_line(error.line()));
    spdlog::debug("{}", error.line());
}

void Scheduler::each(const Task& task) {
    std::vector<std::pair<std::size_t, Error>> failures;
    const std::vector<std::size_t> devices = left();
    for (const std::size_t device : devices) {
        try {
            task(device);
        } catch (const Error& error) {
            if (!is_device_failure(error)) throw;
            failures.emplace_back(device, error);
        }
    }
    if (failures.size() == devices.size()) throw Error(failures.back().second); // what none can do is no device's failure
    for (const auto& [device, error] : failures) drop(device, error);
}

void Scheduler::compare(const std::string& what, const std::function<std::string(std::size_t)>& result) {
    if (left().size() < 2) return;
    std::map<std::string, std::vector<std::size_t>> who; // by result
    each([&](std::size_t device) { who[result(device)].push_back(device); });
    const std::size_t devices = left().size();
    const auto most =
        std::max_element(who.begin(), who.end(), [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    if (2 * most->second.size() <= devices) {
        std::string names;
        for (const std::size_t d : left()) names += (names.empty() ? "" : ", ") + names_[d];
        throw Error(ErrorKind::device,
                    "compute different " + what + ", so one of them is wrong; take one alone, `clvr selftest` may tell which", names);
    }
    for (const auto& [value, those] : who)
        for (const std::size_t d : those)
            if (value != most->first) drop(d, Error(ErrorKind::device, "computes other " + what + " than the other devices", names_[d]));
}

void Scheduler::run(const std::string& label, std::uint32_t total, double cost, const std::vector<ChunkSize>& chunk_sizes,
                    const Work& work) {
    const std::vector<std::size_t> devices = left();
    std::vector<Speed>& speeds = speeds_.try_emplace(label, names_.size()).first->second;
    Queue queue(total, cost, chunk_sizes, speeds, devices);
    const auto drive = [&](std::size_t device) {
        while (const auto chunk = queue.take(device)) {
            try {
                work(device, chunk->first, chunk->count);
                queue.done(device, *chunk);
            } catch (const Error& error) {
                if (is_device_failure(error)) return queue.leave(device, *chunk, [&] { drop(device, error); });
                return queue.end(std::current_exception());
            } catch (...) {
                return queue.end(std::current_exception());
            }
        }
    };
    std::vector<std::thread> threads;
    for (std::size_t k = 1; k < devices.size(); ++k) threads.emplace_back(drive, devices[k]);
    drive(devices.front());
    for (std::thread& thread : threads) thread.join();
    queue.rethrow();
}

} // namespace clvr
