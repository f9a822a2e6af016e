// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace beamgyro {

/// The threads that work may use: `wanted`, or with 0 as many as there are
/// cores.
unsigned thread_count(unsigned wanted);

/// Work on task number `index`, by thread number `worker` of those at work.
using Task = std::function<void(std::size_t index, std::size_t worker)>;

/// Calls `task` once for every index below `count`, in order, on `threads`
/// threads that each take the next one; the caller is one of them, worker 0.
/// Threads that the system does not grant are fewer threads.
///
/// After an exception no other task begins, and when those at work are done it
/// is rethrown: of several the one of the lowest index, which does not depend
/// on the number of threads.
void for_each_task(std::size_t count, std::size_t threads, const Task& task);

}  // namespace beamgyro
