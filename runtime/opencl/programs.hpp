// The programs of a device: each is built once, some before they are needed.
#pragma once
#include "runtime/drivers/opencl.hpp"

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace clvr {

/// May be used by several threads at the same time; one build runs at a time, as drivers have it, too.
class Programs {
public:
    /// A stage and its definitions: what Device::kernel takes.
    using Key = std::pair<std::string, std::map<std::string, std::string>>;
    using Build = std::function<cl::Program(const Key&)>;

    explicit Programs(Build build) : build_(std::move(build)) {}
    /// Waits for the build that runs; those that wait are left out.
    ~Programs();
    Programs(const Programs&) = delete;
    Programs& operator=(const Programs&) = delete;

    /// Lets a thread of its own build the program, after those asked for before. What goes wrong, get() says.
    void prepare(const Key& key);
    /// The program, built now unless it is there. Throws what `build` throws, each time anew.
    cl::Program get(const Key& key);

private:
    struct Entry {
        std::optional<cl::Program> program;
        std::exception_ptr failure;
    };
    void build(const Key& key, std::unique_lock<std::mutex>& lock);
    void work();

    Build build_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<Key, Entry> entries_;
    std::deque<Key> waiting_;
    bool busy_ = false, ending_ = false;
    std::thread thread_; // from the first prepare() on
};

} // namespace clvr
