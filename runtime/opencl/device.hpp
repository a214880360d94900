// An opened OpenCL device: context, in-order profiling queue, program store, memory account, tunables.
#pragma once
#include "runtime/drivers/facts.hpp"
#include "runtime/drivers/opencl.hpp"
#include "runtime/error.hpp"
#include "runtime/opencl/profile.hpp"
#include "runtime/tune/tunables.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace clvr {

/// Preprocessor definitions of a kernel build: name -> value, in sorted order, part of the program cache's key.
using Defines = std::map<std::string, std::string>;

/// Work-items wanted per dimension. `launch` rounds x and y up to a multiple of the local size, so every kernel guards them; z is never
/// more than was wanted, as a group is one item deep.
struct Range {
    std::size_t x = 1, y = 1, z = 1;
};

/// What a launch moves and computes, where known (0: unknown); feeds the GB/s and GFLOP/s columns of `--profile`.
struct Work {
    double bytes = 0, flops = 0;
};

/// Device memory, accounted: released (and credited back) on destruction. Movable, not copyable; empty when default-constructed.
class Buffer {
public:
    Buffer() = default;
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        handle_ = std::move(other.handle_);
        credit_ = std::move(other.credit_);
        bytes_ = std::exchange(other.bytes_, 0);
        return *this;
    }
    std::size_t bytes() const { return bytes_; }
    explicit operator bool() const { return bytes_ != 0; }
    const cl::Buffer& handle() const { return handle_; }

private:
    friend class Device;
    cl::Buffer handle_;
    std::size_t bytes_ = 0;
    std::shared_ptr<void> credit_; // gives the bytes back to the device's account
};

/// A `__local` argument of the given size in bytes.
struct LocalMemory {
    std::size_t bytes;
};

/// Several buffers as consecutive kernel arguments.
using BufferList = std::vector<const Buffer*>;

/// One entry point, built for one device. The label of its launches is the entry point's name.
class Kernel {
public:
    Kernel() = default;
    const std::string& label() const { return label_; }
    /// Most work-items in a group of this kernel on its device: at most the device's own limit, less where registers or private memory are
    /// short; at most 256 on processors, as PoCL has a group's private memory on a stack of 8 MiB and more gain nothing.
    std::size_t max_local_items() const { return max_local_items_; }
    /// A one-dimensional local size: `wanted`, or what this kernel takes at most on its device.
    Range group(std::size_t wanted) const { return {wanted < max_local_items_ ? wanted : max_local_items_}; }
    /// A local size: `wanted`, halved until this kernel takes it (rusticl on llvmpipe: 32), y before x.
    Range group(Range wanted) const {
        while (wanted.x * wanted.y > max_local_items_ && wanted.x * wanted.y > 1) (wanted.y > 1 ? wanted.y : wanted.x) /= 2;
        return wanted;
    }

private:
    friend class Device;
    cl::Kernel handle_;
    std::string label_;
    std::size_t max_local_items_ = 0;
};

/// A device in use. Cheap to copy (a shared handle); one host thread at a time drives one Device.
class Device {
public:
    /// Opens the device that `facts` describe, whether or not it computes what it should: `open_trusted` (trust/trust.hpp) asks that first.
    /// Throws Error{device} when it has no compiler, naming it.
    static Device open_untested(const DeviceFacts& facts);

    const DeviceFacts& facts() const;

    /// The value of a tunable: the one in force (runtime/tune/tuning.hpp) or set since, else its default, or `by_stage` where the stage
    /// chooses by the shape of its work. `set_tunables` replaces all, whatever was in force. Setting throws Error{usage} for a name or a
    /// value that is not declared.
    int tunable(const Tunable& tunable) const;
    int tunable(const Tunable& tunable, int by_stage) const;
    void set_tunable(const std::string& name, int value);
    void set_tunables(const Tunables& all);

    /// Largest single allocation and what is left of the total in bytes, by clvr's own account
    /// (device limits, lowered by CLVR_MAX_ALLOC, CLVR_MAX_MEMORY and set_memory_limit()).
    std::size_t max_alloc_bytes() const;
    std::size_t free_bytes() const;
    std::size_t used_bytes() const;
    std::size_t peak_bytes() const;
    void set_memory_limit(std::size_t bytes);

    /// Allocates device memory (at least 1 byte). `label` names it in the error. Throws Error{device_memory} before the driver is asked
    /// when it cannot fit.
    Buffer buffer(std::size_t bytes, std::string_view label);

    /// Blocking transfers, bounds-checked; offsets and sizes in bytes.
    void write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset = 0);
    void read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset = 0);
    /// Fills the buffer with one byte value.
    void fill(Buffer& to, unsigned char value);

    template <class T>
    Buffer upload(const std::vector<T>& from, std::string_view label) {
        static_assert(std::is_trivially_copyable_v<T>);
        Buffer b = buffer(from.empty() ? sizeof(T) : from.size() * sizeof(T), label);
        if (!from.empty()) write(b, from.data(), from.size() * sizeof(T));
        return b;
    }
    template <class T>
    std::vector<T> download(const Buffer& from, std::size_t count, std::size_t first = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::vector<T> to(count);
        if (count) read(from, to.data(), count * sizeof(T), first * sizeof(T));
        return to;
    }

    /// The entry point of "kernels/<stage>.cl": stage "render/shade" is file render/shade.cl, entry point shade, label "shade".
    /// Built on first use with `defines`, then kept in process and on disk (there by the driver where it does so).
    /// A build failure throws Error{device} whose text holds the compiler's log with file and line.
    Kernel kernel(const std::string& stage, const Defines& defines = {});
    /// Has the program of an entry point built on a thread of its own, for kernel() to find. On PoCL each takes about 10 ms of one core
    /// even when it is in the driver's cache.
    void prepare(const std::string& stage, const Defines& defines = {});

    /// Enqueues a kernel over `global` (rounded up to `local`); arguments are Buffer, BufferList (an argument each), LocalMemory or
    /// trivially copyable values, in order.
    template <class... Args>
    void launch(Kernel& k, Range global, Range local, Work work, const Args&... args) {
        cl_uint i = 0;
        (set_arg(k, i, args), ...);
        enqueue(k, global, local, work);
    }

    /// Waits for everything enqueued.
    void finish();

    /// Timings of all launches and transfers since opening (times resolved by finish()).
    Profile& profile();

    const cl::Context& context() const;
    cl::CommandQueue& queue();

private:
    struct State;
    std::shared_ptr<State> state_;
    void set_arg_bytes(Kernel& k, cl_uint i, std::size_t bytes, const void* value);
    // Each sets the arguments from index i on and moves i behind them.
    void set_arg(Kernel& k, cl_uint& i, const Buffer& b) { set_arg_bytes(k, i++, sizeof(cl_mem), &b.handle()()); }
    void set_arg(Kernel& k, cl_uint& i, const BufferList& list) {
        for (const Buffer* b : list) set_arg(k, i, *b);
    }
    void set_arg(Kernel& k, cl_uint& i, const LocalMemory& m) { set_arg_bytes(k, i++, m.bytes, nullptr); }
    template <class T>
    void set_arg(Kernel& k, cl_uint& i, const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        set_arg_bytes(k, i++, sizeof(T), &value);
    }
    void enqueue(Kernel& k, Range global, Range local, Work work);
};

} // namespace clvr
