#include "runtime/system/parallel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace clvr {

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
    if (count == 1) {
        work(0);
        return;
    }
    // TBB orders caller, calls and caller by itself. The counter says so once more, for ThreadSanitizer, which does not see into TBB.
    std::atomic<std::size_t> order{0};
    order.fetch_add(1, std::memory_order_release);
    const tbb::blocked_range<std::size_t> one_each(0, count, 1);
    tbb::parallel_for(
        one_each,
        [&](const tbb::blocked_range<std::size_t>& some) {
            order.load(std::memory_order_acquire);
            for (std::size_t i = some.begin(); i != some.end(); ++i) work(i);
            order.fetch_add(1, std::memory_order_release);
        },
        tbb::simple_partitioner());
    order.load(std::memory_order_acquire);
}

std::size_t part_count(std::size_t count) {
    return std::min(count, 4 * static_cast<std::size_t>(std::max(1, tbb::this_task_arena::max_concurrency())));
}

void for_parts(std::size_t count, const std::function<void(std::size_t, std::size_t, std::size_t)>& work) {
    const std::size_t parts = part_count(count);
    for_each_index(parts, [&](std::size_t part) { work(part, count * part / parts, count * (part + 1) / parts); });
}

} // namespace clvr
