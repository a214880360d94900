// Between host and device: from usual memory, from pinned memory, and by mapping.
#include "runtime/drivers/check.hpp"
#include "tools/bench/stage.hpp"

#include <cstring>

namespace clvr::bench {
namespace {

/// Host memory that the driver keeps in place, as a mapped buffer of its own.
class Pinned {
public:
    Pinned(Device& d, std::size_t bytes) : device_(d) {
        cl_check("pinned memory of " + d.facts().name, [&] {
            buffer_ = cl::Buffer(d.context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes);
            data_ = static_cast<float*>(d.queue().enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes));
        });
    }
    ~Pinned() {
        try {
            device_.queue().enqueueUnmapMemObject(buffer_, data_);
            device_.queue().finish();
        } catch (const cl::Error&) { // the process is about to forget it anyhow
        }
    }
    Pinned(const Pinned&) = delete;
    Pinned& operator=(const Pinned&) = delete;
    float* data() { return data_; }

private:
    Device device_;
    cl::Buffer buffer_;
    float* data_ = nullptr;
};

enum class Way { pageable, pinned, mapped };

/// One direction. What arrives is hashed from where it arrived.
StageRun transfer(std::vector<Device>& devices, Size size, Way way, bool to_device) {
    Device d = devices.front();
    const std::size_t floats = size == Size::tiny ? 1 << 12 : 1 << 22, bytes = floats * 4;
    const auto source = std::make_shared<std::vector<float>>(noise_values(floats));
    const auto there = std::make_shared<Buffer>(d.upload(*source, "transfer"));
    if (to_device) d.fill(*there, 0);
    std::shared_ptr<Pinned> pinned;
    std::shared_ptr<std::vector<float>> here;
    float* host = nullptr;
    if (way == Way::pinned) {
        pinned = std::make_shared<Pinned>(d, bytes);
        host = pinned->data();
        std::memcpy(host, source->data(), bytes);
    } else {
        here = std::make_shared<std::vector<float>>(*source);
        host = here->data();
    }
    if (!to_device) std::memset(host, 0, bytes);
    StageRun r;
    r.run = [=]() mutable {
        static_cast<void>(pinned), static_cast<void>(here); // kept as long as `host`
        if (way != Way::mapped) {
            to_device ? d.write(*there, host, bytes) : d.read(*there, host, bytes);
            d.finish();
            return;
        }
        cl_check("mapping on " + d.facts().name, [&] {
            void* mapped = d.queue().enqueueMapBuffer(there->handle(), CL_TRUE, to_device ? CL_MAP_WRITE : CL_MAP_READ, 0, bytes);
            to_device ? std::memcpy(mapped, host, bytes) : std::memcpy(host, mapped, bytes);
            d.queue().enqueueUnmapMemObject(there->handle(), mapped);
            d.queue().finish();
        });
    };
    r.hash = [=]() mutable { return hash_of(to_device ? d.download<float>(*there, floats) : std::vector<float>(host, host + floats)); };
    r.items = r.bytes = static_cast<double>(bytes);
    return r;
}

} // namespace

std::vector<Stage> transfer_stages() {
    std::vector<Stage> all;
    for (const auto& [way, name] : {std::pair(Way::pageable, "pageable"), {Way::pinned, "pinned"}, {Way::mapped, "mapped"}})
        for (const bool to_device : {true, false})
            all.push_back({std::string(to_device ? "write, " : "read, ") + name, "GB/s", 1e9, Ceiling::none, "", true, "",
                           [by = way, to_device](auto& d, Size s) { return transfer(d, s, by, to_device); }});
    return all;
}

} // namespace clvr::bench
