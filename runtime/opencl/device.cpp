#include "runtime/opencl/device.hpp"

#include "runtime/drivers/check.hpp"
#include "runtime/drivers/quirks.hpp"
#include "runtime/opencl/account.hpp"
#include "runtime/opencl/fault.hpp"
#include "runtime/opencl/program.hpp"
#include "runtime/opencl/programs.hpp"
#include "runtime/system/size.hpp"
#include "runtime/tune/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <tuple>

namespace clvr {
namespace {

/// Events kept before the older half is waited for and read.
constexpr std::size_t max_pending_events = 1024;

constexpr std::size_t most_on_a_processor = 256; // work-items in a group

std::size_t rounded_up(std::size_t value, std::size_t multiple) { return (value + multiple - 1) / multiple * multiple; }

} // namespace

struct Device::State {
    struct Pending {
        cl::Event event;
        std::string label;
        Work work;
    };
    DeviceFacts facts;
    cl::Context context;
    cl::CommandQueue queue;
    std::shared_ptr<Account> account;
    std::size_t max_alloc_bytes = 0, max_memory_bytes = 0;
    Tunables tunables;
    std::deque<Pending> pending;
    Profile profile;
    std::unique_ptr<Faults> faults;   // null: none are put in
    std::optional<Programs> programs; // the last member: its thread uses those above

    cl::Program build(const Programs::Key& key) const {
        Defines all = key.second;
        if (faults && faults->breaks_build(key.first)) all["__kernel"] = "broken_by_CLVR_FAULT";
        return build_program(context, facts, key.first + ".cl", all);
    }

    /// The driver's calls, through the faults.
    template <class Call>
    void drive(const char* what, const char* name, Call&& call) {
        cl_check([&] { return doing(what); },
                 [&] {
                     if (faults) faults->call(name);
                     call();
                 });
    }

    std::string doing(std::string_view what) const { return fmt::format("{} on {}", what, facts.name); }

    /// Notes a command for the profile.
    void track(const cl::Event& event, const std::string& label, Work work) {
        pending.push_back({event, label, work});
        if (pending.size() >= max_pending_events) resolve(max_pending_events / 2);
    }

    /// Waits for the first `count` pending commands (the queue is in order) and books their times.
    void resolve(std::size_t count) {
        if (count == 0) return;
        cl_check([&] { return doing(pending[count - 1].label); }, [&] { pending[count - 1].event.wait(); });
        for (; count > 0; --count) {
            const Pending& first = pending.front();
            const auto [start, end] = cl_check([&] { return doing("timing " + first.label); },
                                               [&] {
                                                   return std::pair(first.event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
                                                                    first.event.getProfilingInfo<CL_PROFILING_COMMAND_END>());
                                               });
            profile.add(first.label, quirks::milliseconds_though_stamps_run_backwards(start, end), first.work.bytes, first.work.flops);
            pending.pop_front();
        }
    }

    void require_range(const Buffer& buffer, std::size_t bytes, std::size_t offset, const char* what) const {
        if (offset > buffer.bytes() || bytes > buffer.bytes() - offset)
            throw Error(ErrorKind::internal,
                        fmt::format("{} of {} bytes at {} leaves a buffer of {} bytes", what, bytes, offset, buffer.bytes()), facts.name);
    }
};

Device Device::open_untested(const DeviceFacts& facts) {
    if (const std::string why = why_unusable(facts); !why.empty())
        throw Error(ErrorKind::device, why + "; try another --device", facts.name);
    Device device;
    device.state_ = std::make_shared<State>();
    State& state = *device.state_;
    state.facts = facts;
    state.tunables = tuning_in_force(facts).values;
    state.max_alloc_bytes = std::min(facts.max_alloc_bytes, size_from_environment("CLVR_MAX_ALLOC").value_or(facts.max_alloc_bytes));
    state.max_memory_bytes = std::min(facts.global_bytes, size_from_environment("CLVR_MAX_MEMORY").value_or(facts.global_bytes));
    cl_check(state.doing("opening"), [&] {
        state.context = facts.context() ? facts.context : cl::Context(facts.handle);
        state.facts.context = state.context;
        state.queue = cl::CommandQueue(state.context, facts.handle, CL_QUEUE_PROFILING_ENABLE);
        const cl_device_id parent = facts.sub_devices ? facts.handle.getInfo<CL_DEVICE_PARENT_DEVICE>()() : nullptr;
        state.account = account_of(parent ? parent : facts.handle());
        state.faults = Faults::of(facts);
    });
    state.programs.emplace([&state](const Programs::Key& key) { return state.build(key); });
    return device;
}

const DeviceFacts& Device::facts() const { return state_->facts; }

int Device::tunable(const Tunable& tunable) const { return value_of(tunable, state_->facts, state_->tunables); }

int Device::tunable(const Tunable& tunable, int by_stage) const {
    const auto found = state_->tunables.find(tunable.name);
    return found == state_->tunables.end() ? by_stage : found->second;
}

void Device::set_tunable(const std::string& name, int value) {
    if (const std::string why = why_refused(name, value); !why.empty()) throw Error(ErrorKind::usage, why, "set_tunable");
    state_->tunables[name] = value;
}

void Device::set_tunables(const Tunables& all) {
    state_->tunables.clear();
    for (const auto& [name, value] : all) set_tunable(name, value);
}

std::size_t Device::max_alloc_bytes() const { return std::min(state_->max_alloc_bytes, state_->max_memory_bytes); }

std::size_t Device::free_bytes() const {
    const std::size_t used = used_bytes();
    return used < state_->max_memory_bytes ? state_->max_memory_bytes - used : 0;
}

std::size_t Device::used_bytes() const { return state_->account->used(); }

std::size_t Device::peak_bytes() const { return state_->account->peak(); }

void Device::set_memory_limit(std::size_t bytes) { state_->max_memory_bytes = std::min(bytes, state_->facts.global_bytes); }

Buffer Device::buffer(std::size_t bytes, std::string_view label) {
    bytes = std::max<std::size_t>(bytes, 1);
    const std::string where = fmt::format("{} on {}", label, state_->facts.name);
    if (bytes > max_alloc_bytes())
        throw Error(ErrorKind::device_memory,
                    fmt::format("wants {} in one buffer, the device takes at most {}; try a smaller picture or another --device",
                                size_text(bytes), size_text(max_alloc_bytes())),
                    where);
    const std::shared_ptr<Account> account = state_->account;
    if (!account->take(bytes, state_->max_memory_bytes))
        throw Error(ErrorKind::device_memory,
                    fmt::format("wants {}, of {} only {} are left; try a higher --memory, a smaller picture or another --device",
                                size_text(bytes), size_text(state_->max_memory_bytes), size_text(free_bytes())),
                    where);
    Buffer result;
    result.credit_ = std::shared_ptr<void>(account.get(), [account, bytes](void*) { account->give_back(bytes); });
    result.handle_ = cl_check(where, [&] {
        if (state_->faults) state_->faults->allocate();
        return cl::Buffer(state_->context, CL_MEM_READ_WRITE, bytes);
    });
    result.bytes_ = bytes;
    return result;
}

void Device::write(Buffer& to, const void* from, std::size_t bytes, std::size_t offset) {
    state_->require_range(to, bytes, offset, "a write");
    if (bytes == 0) return;
    cl::Event event;
    state_->drive("writing", "clEnqueueWriteBuffer",
                  [&] { state_->queue.enqueueWriteBuffer(to.handle_, CL_TRUE, offset, bytes, from, nullptr, &event); });
    state_->track(event, "write", {static_cast<double>(bytes), 0});
}

void Device::read(const Buffer& from, void* to, std::size_t bytes, std::size_t offset) {
    state_->require_range(from, bytes, offset, "a read");
    if (bytes == 0) return;
    cl::Event event;
    state_->drive("reading", "clEnqueueReadBuffer",
                  [&] { state_->queue.enqueueReadBuffer(from.handle_, CL_TRUE, offset, bytes, to, nullptr, &event); });
    if (state_->faults) state_->faults->read(to, bytes);
    state_->track(event, "read", {static_cast<double>(bytes), 0});
}

void Device::fill(Buffer& to, unsigned char value) {
    if (!to) return;
    cl::Event event;
    state_->drive("filling", "clEnqueueFillBuffer",
                  [&] { state_->queue.enqueueFillBuffer(to.handle_, value, 0, to.bytes(), nullptr, &event); });
    state_->track(event, "fill", {static_cast<double>(to.bytes()), 0});
}

void Device::prepare(const std::string& stage, const Defines& defines) { state_->programs->prepare({stage, defines}); }

Kernel Device::kernel(const std::string& stage, const Defines& defines) {
    const cl::Program program = state_->programs->get({stage, defines});
    Kernel kernel;
    kernel.label_ = stage.substr(stage.rfind('/') + 1);
    cl_check(state_->doing("entry point " + kernel.label_), [&] {
        kernel.handle_ = cl::Kernel(program, kernel.label_.c_str());
        kernel.max_local_items_ = kernel.handle_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(state_->facts.handle);
        if (state_->facts.type == DeviceType::cpu) kernel.max_local_items_ = std::min(kernel.max_local_items_, most_on_a_processor);
    });
    return kernel;
}

void Device::set_arg_bytes(Kernel& k, cl_uint i, std::size_t bytes, const void* value) {
    cl_check([&] { return fmt::format("argument {} ({} bytes) of kernel {}", i, bytes, k.label_); },
             [&] { k.handle_.setArg(i, bytes, value); });
}

void Device::enqueue(Kernel& k, Range global, Range local, Work work) {
    const std::size_t group = local.x * local.y * local.z;
    if (group == 0) throw Error(ErrorKind::internal, "a local size of 0", k.label_);
    if (global.x == 0 || global.y == 0 || global.z == 0) return;
    const std::size_t* items = state_->facts.max_work_item;
    if (group > k.max_local_items_ || local.x > items[0] || local.y > items[1] || local.z > items[2])
        throw Error(ErrorKind::device,
                    fmt::format("a local size of {}x{}x{} is above the limit of {} (at most {}x{}x{})", local.x, local.y, local.z,
                                k.max_local_items_, items[0], items[1], items[2]),
                    state_->doing(k.label_));
    const cl::NDRange rounded(rounded_up(global.x, local.x), rounded_up(global.y, local.y), rounded_up(global.z, local.z));
    cl::Event event;
    cl_check([&] { return state_->doing(k.label_); },
             [&] {
                 if (state_->faults) state_->faults->launch(k.label_);
                 state_->queue.enqueueNDRangeKernel(k.handle_, cl::NullRange, rounded, cl::NDRange(local.x, local.y, local.z), nullptr,
                                                    &event);
             });
    state_->track(event, k.label_, work);
}

void Device::finish() {
    state_->drive("finishing", "clFinish", [&] { state_->queue.finish(); });
    state_->resolve(state_->pending.size());
}

Profile& Device::profile() { return state_->profile; }

const cl::Context& Device::context() const { return state_->context; }

cl::CommandQueue& Device::queue() { return state_->queue; }

} // namespace clvr
