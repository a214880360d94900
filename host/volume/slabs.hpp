// Work over a range of slabs, shared by two threads.
#pragma once
#include <future>

namespace clvr {

/// Calls work(first, last) for the two halves of 0..count, at the same time. Exceptions of either half reach the caller.
template <class F>
void for_slabs(int count, F&& work) {
    const int middle = count / 2;
    if (middle == 0) {
        work(0, count);
        return;
    }
    auto upper = std::async(std::launch::async, [&] { work(middle, count); });
    work(0, middle);
    upper.get();
}

} // namespace clvr
