// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace beamgyro::internal {

/// Returns the number of threads to use: `wanted`, or one per core if that is
/// 0.
unsigned thread_count(unsigned wanted);

/// Carries out task number `index` on thread number `worker`.
using Task = std::function<void(std::size_t index, std::size_t worker)>;

/// Calls `task` once for every index below `count`. Each of `threads` threads
/// takes the next index when it is free; the caller is worker 0. If the system
/// refuses threads, the work is done with fewer.
///
/// After an exception no further task begins. When the running tasks are done
/// the exception is rethrown; of several, that of the lowest index, so that it
/// does not depend on the number of threads.
void for_each_task(std::size_t count, std::size_t threads, const Task& task);

}  // namespace beamgyro::internal
