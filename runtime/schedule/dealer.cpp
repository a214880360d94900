#include "runtime/schedule/dealer.hpp"

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

struct Run {
    std::uint32_t first, count;
};

/// What is not dealt yet, and who has what.
class Table {
public:
    Table(std::uint32_t total, double cost, const std::vector<Dealer::Portion>& portions, std::vector<Dealer::Speed>& speeds,
          const std::vector<std::size_t>& devices)
        : total_(total), rest_(total), cost_(cost), portions_(portions), speeds_(speeds), hands_(portions.size()) {
        if (total > 0) runs_.push_back({0, total});
        for (const std::size_t d : devices) hands_[d].present = true;
    }

    /// The device's next run; waits while others might still give theirs back. Nothing when all is done or the deal has ended.
    std::optional<Run> take(std::size_t device) {
        std::unique_lock lock(mutex_);
        for (;;) {
            if (failure_ || (rest_ == 0 && busy() == 0)) return std::nullopt;
            if (rest_ > 0) {
                const std::uint32_t count = portion(device);
                if (!another_ends_sooner(device, count)) return cut(device, count);
            }
            changed_.wait_for(lock, patience);
        }
    }

    void done(std::size_t device, const Run& run) {
        const std::lock_guard lock(mutex_);
        Hand& hand = hands_[device];
        speeds_[device].add(run.count * cost_ / std::max(1e-9, seconds_between(hand.since, Clock::now())));
        hand.busy = false;
        changed_.notify_all();
    }

    /// The device is out of the game; its run goes back. `drop` may throw, which ends the deal.
    template <class Drop>
    void leave(std::size_t device, const Run& run, Drop&& drop) {
        const std::lock_guard lock(mutex_);
        hands_[device].busy = hands_[device].present = false;
        runs_.push_back(run);
        rest_ += run.count;
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
    struct Hand {
        bool present = false, busy = false;
        Clock::time_point since;
        double expected_s = 0; // of its run; 0: unknown
    };
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Run> runs_; // not dealt; taken from the front of the last one
    std::uint32_t total_, rest_;
    double cost_;
    const std::vector<Dealer::Portion>& portions_;
    std::vector<Dealer::Speed>& speeds_;
    std::vector<Hand> hands_;
    std::exception_ptr failure_;

    std::size_t busy() const {
        return static_cast<std::size_t>(std::count_if(hands_.begin(), hands_.end(), [](const Hand& h) { return h.busy; }));
    }

    std::uint32_t portion(std::size_t device) const {
        const Dealer::Portion& p = portions_[device];
        double present = 0, known = 0, sum = 0;
        for (std::size_t d = 0; d < hands_.size(); ++d)
            if (hands_[d].present) present += 1, known += speeds_[d].rate > 0, sum += speeds_[d].rate;
        double share = 1; // of the rest
        if (present > 1) {
            const double own = speeds_[device].rate;
            share = own > 0 ? 0.5 * own / (sum / known * present) : 0.25 / present * total_ / rest_;
        }
        const double wanted = std::min<double>(p.most, share * rest_);
        const std::uint32_t least = std::max(1u, p.least), count = std::max(1u, static_cast<std::uint32_t>(wanted) / least) * least;
        const std::uint32_t run = runs_.back().count;
        return count >= run || (run - count < least && run <= p.most) ? run : count; // leaves no crumb
    }

    /// Whether another device will have done all of the rest before this one has done so many. Of two devices never either says so of the
    /// other: who would do all of it soonest takes.
    bool another_ends_sooner(std::size_t device, std::uint32_t count) const {
        if (speeds_[device].rate <= 0) return false;
        const double own_s = count * cost_ / speeds_[device].rate;
        const auto now = Clock::now();
        for (std::size_t d = 0; d < hands_.size(); ++d) {
            const Hand& h = hands_[d];
            if (d == device || !h.present || speeds_[d].rate <= 0) continue;
            double wait_s = 0;
            if (h.busy) { // one that is late is taken to need as long again as it is late
                wait_s = std::abs(h.expected_s - seconds_between(h.since, now));
            }
            if (wait_s + rest_ * cost_ / speeds_[d].rate < own_s) return true;
        }
        return false;
    }

    Run cut(std::size_t device, std::uint32_t count) {
        Run& from = runs_.back();
        const Run run{from.first, count};
        from.first += count, from.count -= count, rest_ -= count;
        if (from.count == 0) runs_.pop_back();
        const double rate = speeds_[device].rate;
        hands_[device].busy = true;
        hands_[device].since = Clock::now();
        hands_[device].expected_s = rate > 0 ? count * cost_ / rate : 0;
        return run;
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

bool is_device_failure(const Error& error) { return error.kind() == ErrorKind::device || error.kind() == ErrorKind::memory; }

void Dealer::Speed::add(double measured) {
    // The first run pays for what drivers do at a kernel's first launch.
    rate = runs < 2 ? measured : 0.5 * (rate + measured);
    ++runs;
}

Dealer::Dealer(const std::vector<Device>& devices) : left_(devices.size(), true) {
    for (const Device& d : devices) names_.push_back(display_name(d.facts()));
}

std::vector<std::size_t> Dealer::left() const {
    std::vector<std::size_t> devices;
    for (std::size_t d = 0; d < left_.size(); ++d)
        if (left_[d]) devices.push_back(d);
    if (devices.empty()) throw Error(ErrorKind::device, "no device is left: all have failed");
    return devices;
}

double Dealer::speed(const std::string& label, std::size_t device) const {
    const auto found = speeds_.find(label);
    return found == speeds_.end() ? 0 : found->second.at(device).rate;
}

void Dealer::drop(std::size_t device, const Error& error) {
    left_[device] = false;
    if (std::find(left_.begin(), left_.end(), true) == left_.end()) throw Error(error);
    spdlog::warn("{} failed and is left out, the other devices do its work: {}", names_[device], first_line(error.line()));
    spdlog::debug("{}", error.line());
}

void Dealer::each(const Task& task) {
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

void Dealer::compare(const std::string& what, const std::function<std::string(std::size_t)>& result) {
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

void Dealer::deal(const std::string& label, std::uint32_t total, double cost, const std::vector<Portion>& portions, const Work& work) {
    const std::vector<std::size_t> devices = left();
    std::vector<Speed>& speeds = speeds_.try_emplace(label, names_.size()).first->second;
    Table table(total, cost, portions, speeds, devices);
    const auto drive = [&](std::size_t device) {
        while (const auto run = table.take(device)) {
            try {
                work(device, run->first, run->count);
                table.done(device, *run);
            } catch (const Error& error) {
                if (is_device_failure(error)) return table.leave(device, *run, [&] { drop(device, error); });
                return table.end(std::current_exception());
            } catch (...) {
                return table.end(std::current_exception());
            }
        }
    };
    std::vector<std::thread> threads;
    for (std::size_t k = 1; k < devices.size(); ++k) threads.emplace_back(drive, devices[k]);
    drive(devices.front());
    for (std::thread& thread : threads) thread.join();
    table.rethrow();
}

} // namespace clvr
