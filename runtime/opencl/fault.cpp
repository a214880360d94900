#include "runtime/opencl/fault.hpp"

#include "runtime/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>

namespace clvr {
namespace {

thread_local int probes = 0; // ProbeScopes of this thread

/// A whole number of at most 6 digits, or -1.
int number_of(const std::string& text) {
    const bool digits = !text.empty() && text.size() <= 6 && text.find_first_not_of("0123456789") == std::string::npos;
    return digits ? std::stoi(text) : -1;
}

/// Whether "@0.2" or such means the device; an empty target means each.
bool is_meant(const std::string& target, const DeviceFacts& device, const Error& malformed) {
    if (target.empty()) return true;
    const std::size_t dot = target.find('.');
    const int index = number_of(target.substr(0, dot)), part = dot == target.npos ? 0 : number_of(target.substr(dot + 1));
    if (index < 0 || part < 0) throw malformed;
    return device.index == index && (part == 0 || device.sub_device + 1 == part);
}

/// "shade" of "render/shade".
std::string label_of(const std::string& stage) { return stage.substr(stage.rfind('/') + 1); }

} // namespace

std::unique_ptr<Faults> Faults::of(const DeviceFacts& device) {
    const char* text = std::getenv("CLVR_FAULT");
    if (!text || !*text) return nullptr;
    auto faults = std::make_unique<Faults>();
    std::istringstream items(text);
    for (std::string item; std::getline(items, item, ',');) {
        const Error malformed(ErrorKind::usage,
                              fmt::format("\"{}\" is no fault; expected launch:N, alloc:N, build:STAGE, result:STAGE or delay:MS, "
                                          "with @DEVICE or @DEVICE.PART for one device",
                                          item),
                              "CLVR_FAULT");
        const std::size_t colon = item.find(':'), at = item.find('@');
        if (colon == item.npos || at < colon) throw malformed;
        Fault fault;
        fault.kind = item.substr(0, colon);
        const std::string value = item.substr(colon + 1, at == item.npos ? at : at - colon - 1);
        if (fault.kind == "build" || fault.kind == "result") {
            fault.stage = value;
            if (value.empty()) throw malformed;
        } else if (fault.kind == "launch" || fault.kind == "alloc" || fault.kind == "delay") {
            fault.number = number_of(value);
            if (fault.number < 1) throw malformed;
        } else {
            throw malformed;
        }
        if (!is_meant(at == item.npos ? "" : item.substr(at + 1), device, malformed)) continue;
        if (probes == 0 || fault.kind == "result") faults->faults_.push_back(fault);
    }
    return faults->faults_.empty() ? nullptr : std::move(faults);
}

void Faults::call(const char* name) const {
    if (lost_) throw cl::Error(CL_DEVICE_NOT_AVAILABLE, name);
}

void Faults::launch(const std::string& label) {
    ++launches_;
    for (const Fault& f : faults_) {
        if (f.kind == "launch" && f.number == launches_) lost_ = true;
        if (f.kind == "delay") std::this_thread::sleep_for(std::chrono::milliseconds(f.number));
        if (f.kind == "result" && label_of(f.stage) == label) spoil_next_ = true;
    }
    call("clEnqueueNDRangeKernel");
}

void Faults::allocate() {
    ++allocations_;
    for (const Fault& f : faults_)
        if (f.kind == "alloc" && f.number == allocations_) throw cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clCreateBuffer");
    call("clCreateBuffer");
}

void Faults::read(void* data, std::size_t bytes) {
    if (!std::exchange(spoil_next_, false)) return;
    static_cast<unsigned char*>(data)[bytes / 2 / 4 * 4] ^= 1; // the last bit of the middle number
}

bool Faults::breaks_build(const std::string& stage) const {
    return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& f) { return f.kind == "build" && f.stage == stage; });
}

bool Faults::spoils_results() const {
    return std::any_of(faults_.begin(), faults_.end(), [](const Fault& f) { return f.kind == "result"; });
}

ProbeScope::ProbeScope() { ++probes; }
ProbeScope::~ProbeScope() { --probes; }

} // namespace clvr
