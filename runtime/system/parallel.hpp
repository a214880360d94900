// Work that all cores share.
#pragma once
#include <cstddef>
#include <functional>

namespace clvr {

/// Calls work(i) once for each i of 0..count, in no order, as many at the same time as there are cores; returns when all are done. What is
/// written must not depend on the order: each call to its own place, or sums of integers. An exception of a call reaches the caller, and
/// calls that have not begun are left out.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

/// In how many parts for_parts cuts 0..count: a few for each core, so that no core waits long for the last one.
std::size_t part_count(std::size_t count);
/// Calls work(part, first, last) for the parts first..last of 0..count, as for_each_index does. Where they begin depends on the number of
/// cores, so results of parts must join to the same bits wherever the cuts are: minima, maxima, sums of integers.
void for_parts(std::size_t count, const std::function<void(std::size_t part, std::size_t first, std::size_t last)>& work);

} // namespace clvr
