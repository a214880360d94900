// Faults put into devices on purpose, to try what clvr does when one fails: a layer between Device and the driver, absent unless the
// environment's CLVR_FAULT names faults when the device is opened.
//
//     CLVR_FAULT=KIND:VALUE[@DEVICE[.PART]][,...]
//
//     launch:N       the N-th launch (from 1) fails as if the device were lost, and so does every later call
//     alloc:N        the N-th allocation alone fails for lack of memory
//     build:STAGE    kernels/STAGE.cl does not build (STAGE as render/shade)
//     result:STAGE   what is read next after a launch of kernels/STAGE.cl has a wrong bit
//     delay:MS       every launch takes MS milliseconds longer
//
// DEVICE is an index as `clvr devices` lists them, PART one of its parts from 1; without them every device has the fault, each for itself.
// Example: CLVR_FAULT=launch:50@0.2 clvr render demo:head -o head.png --device 0/2
#pragma once
#include "runtime/drivers/facts.hpp"

#include <memory>
#include <string>
#include <vector>

namespace clvr {

/// The faults of one opened device. Each member that throws throws cl::Error as the driver would.
class Faults {
public:
    /// Those that CLVR_FAULT has for the device; null when there are none. Throws Error{usage} for a malformed CLVR_FAULT.
    static std::unique_ptr<Faults> of(const DeviceFacts& device);

    /// Before any call: throws when the device is lost.
    void call(const char* name) const;
    void launch(const std::string& label);
    void allocate();
    void read(void* data, std::size_t bytes);
    bool breaks_build(const std::string& stage) const;
    bool spoils_results() const;

    struct Fault {
        std::string kind, stage; ///< stage: of build and result
        int number = 0;          ///< of launch, alloc and delay
    };

private:
    std::vector<Fault> faults_;
    int launches_ = 0, allocations_ = 0;
    bool lost_ = false, spoil_next_ = false;
};

/// While one lives, devices that this thread opens have only wrong results as faults: for probes, whose launches must not count.
class ProbeScope {
public:
    ProbeScope();
    ~ProbeScope();
    ProbeScope(const ProbeScope&) = delete;
    ProbeScope& operator=(const ProbeScope&) = delete;
};

} // namespace clvr
