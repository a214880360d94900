// Work shared by several devices at once, by their measured speed. A device that fails is left out, its work done by the others.
#pragma once
#include "runtime/error.hpp"
#include "runtime/opencl/device.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace clvr {

/// How messages call a device: `device 0 "name"`, `part 1/2 of device 0 "name"`.
std::string display_name(const DeviceFacts& device);

/// Whether both are the same opened device.
bool is_same(Device a, Device b);

/// Enqueues on `device` a copy between buffers of its context, [bytes]; another device of it must have finished with them.
void copy(Device& device, const Buffer& from, Buffer& to, std::size_t bytes, std::size_t from_offset, std::size_t to_offset);

/// Whether an error says that a device (or its memory) failed, so that another one may do the work: kinds device and device_memory. Never
/// the host's memory, which all devices share: that ends the command.
bool is_device_failure(const Error& error);

/// Which devices are left, and how fast each was. Devices are named by their position in the list given.
class Scheduler {
public:
    /// How many numbers a device takes at once: a multiple of `least`, at most `most`.
    struct ChunkSize {
        std::uint32_t least = 1, most = 1;
    };
    using Task = std::function<void(std::size_t device)>;
    using Work = std::function<void(std::size_t device, std::uint32_t first, std::uint32_t count)>;

    explicit Scheduler(const std::vector<Device>& devices);
    /// For anything else that works: what to call each in warnings.
    explicit Scheduler(std::vector<std::string> names) : names_(std::move(names)), left_(names_.size(), true) {}

    /// task(device) for every device that is left, in order, on the calling thread.
    void each(const Task& task);

    /// Calls work(device, first, count) on a thread a device until each of the numbers 0 .. total - 1 was done; `work` returns when the
    /// device is done. Each call is a chunk of the numbers. Its size is half of what would make all devices end together, by the speeds of
    /// earlier chunks with this `label` (numbers times `cost` a second), within the device's `chunk_sizes`. So chunks get small towards the
    /// end, and fast devices take more of them. A device takes none when another will have done all that is left before this one could do
    /// its chunk. The chunk of a device that fails is done anew by another one: `work` must give the same when it is repeated. Any other
    /// exception ends the work and is thrown on.
    void run(const std::string& label, std::uint32_t total, double cost, const std::vector<ChunkSize>& chunk_sizes, const Work& work);

    /// Whether devices compute the same: those whose result(device) differs from that of more than half of the devices left are dropped.
    /// Throws Error{device} when there is no such majority, naming the devices. `what` is computed, for the message: "different <what>".
    void compare(const std::string& what, const std::function<std::string(std::size_t device)>& result);

    /// Leaves a device out and warns in one line that says why. Throws `error` when no other is left.
    void drop(std::size_t device, const Error& error);

    /// Positions of the devices that have not failed, in order; at least one. Throws Error{device} when none is left.
    std::vector<std::size_t> left() const;

    /// Numbers times cost a second of a device under a label; 0 before its first chunk.
    double speed(const std::string& label, std::size_t device) const;

    /// A device's rate by its latest chunks.
    struct Speed {
        double rate = 0;
        int chunks = 0;
        void add(double measured);
    };

private:
    std::vector<std::string> names_;
    std::vector<bool> left_;
    std::map<std::string, std::vector<Speed>> speeds_;
};

/// task(device) on the first device that can. Those that fail before are taken from the list, with a warning; the last one's error is
/// thrown.
template <class Task>
auto on_first(std::vector<Device>& devices, Task&& task) {
    for (;;) {
        try {
            return task(devices.front());
        } catch (const Error& error) {
            if (!is_device_failure(error) || devices.size() < 2) throw;
            Scheduler(devices).drop(0, error);
            devices.erase(devices.begin());
        }
    }
}

} // namespace clvr
