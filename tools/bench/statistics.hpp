// Calibrated timing: warmed up, probed, in batches, with a reference loop between them that tells when the machine itself went slow.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace clvr::bench {

/// Seconds since some moment. A steady clock in the product; tests bring their own, which may jump.
using Clock = std::function<double()>;
double steady_seconds();

/// Middle value (mean of the two middle ones); NaN of nothing.
double median(std::vector<double> values);
/// Half the interquartile range over the median: 0.02 says that half of the values lie within about +-2 %. 0 below 3 values.
double spread(std::vector<double> values);

/// How fast the machine itself is at the moment: a fixed loop's seconds against the best ever seen. Shared machines and laptops change
/// between speeds (this project's first one between full and half), and a batch of a slow phase says nothing about the program.
class Pace {
public:
    /// `best`: seconds known from before, 0: none. Without a loop the pace is always even (a graphics card's host).
    explicit Pace(Clock clock, std::function<void()> loop = {}, double best = 0);
    /// Runs the loop: its seconds, or 0 without one. What takes no time or less (a clock that jumped) is not believed.
    double now();
    double best() const { return best_; }
    /// More than `slow` times the best.
    bool slow_phase(double seconds) const { return best_ > 0 && seconds > slow * best_; }
    static constexpr double slow = 1.3;

private:
    Clock clock_;
    std::function<void()> loop_;
    double best_;
};

struct Plan {
    int batches = 9;
    double batch_seconds = 0.02; ///< a batch repeats the work until it lasts so long
    double limit_seconds = 5;    ///< no further batch begins after so much measured time, but for the first 3
};

struct Timing {
    double median_s = 0, spread = 0; ///< of one run of the work
    double beside_s = 0;             ///< median of the other side, where there was one
    double ratio = 0;                ///< median of beside / work, batch by batch
    double pace_s = 0;               ///< median of the pace during the batches that count
    int batches = 0, repeated = 0;   ///< that count; that were measured again: slow phases and jumps of the clock
    std::string note;                ///< why the numbers are to be doubted; empty when they are not
};

/// Measures `work`, which has run once before (builds, first touches). `beside` runs in turn with it, once a batch. Batches during which
/// the pace was slow, changed, or the clock jumped, are measured again, at most twice as many as wanted; when the slow phase stays, its
/// batches count and the note says so.
Timing measure(const Clock& clock, Pace& pace, const std::function<void()>& work, const Plan& plan = {},
               const std::function<void()>& beside = {});

struct Comparison {
    double speedup = 0; ///< median of base / candidate
    double spread = 0;
    int rounds = 0;
    bool pruned = false; ///< given up early: it is slower by far
};

/// Runs two sides in turn, `rounds` times, each first every other time; gives up after 2 rounds where the candidate takes more than
/// `hopeless` times as long, and begins no further round after `limit_seconds`, but for the first 2.
Comparison compare(const Clock& clock, const std::function<void()>& base, const std::function<void()>& candidate, int rounds,
                   double limit_seconds = 1e9, double hopeless = 1.3);

} // namespace clvr::bench
