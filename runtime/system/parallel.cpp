#include "runtime/system/parallel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace clvr {

namespace {

#ifdef __SANITIZE_THREAD__
/// ThreadSanitizer does not see what orders TBB's tasks; so there, threads take the indices.
void share(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::atomic<std::size_t> next{0};
    std::mutex failing;
    std::exception_ptr failure;
    const auto take = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) work(i);
        } catch (...) {
            const std::lock_guard lock(failing);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    std::vector<std::thread> others;
    for (int k = 0; k < 3; ++k) others.emplace_back(take);
    take();
    for (std::thread& other : others) other.join();
    if (failure) std::rethrow_exception(failure);
}
#else
void share(std::size_t count, const std::function<void(std::size_t)>& work) {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& some) {
            for (std::size_t i = some.begin(); i != some.end(); ++i) work(i);
        },
        tbb::simple_partitioner());
}
#endif

} // namespace

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
    if (count == 1)
        work(0);
    else
        share(count, work);
}

std::size_t part_count(std::size_t count) {
    return std::min(count, 4 * static_cast<std::size_t>(std::max(1, tbb::this_task_arena::max_concurrency())));
}

void for_parts(std::size_t count, const std::function<void(std::size_t, std::size_t, std::size_t)>& work) {
    const std::size_t parts = part_count(count);
    for_each_index(parts, [&](std::size_t part) { work(part, count * part / parts, count * (part + 1) / parts); });
}

} // namespace clvr
