// SPDX-License-Identifier: MIT
#include "parallel/work_queue.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace beamgyro::internal {
namespace {

class WorkQueue {
 public:
  WorkQueue(std::size_t count, const Task& task) : count_(count), task_(task) {}

  // Takes tasks until none is left.
  void work(std::size_t worker) {
    for (std::size_t index = next_++; index < count_; index = next_++) {
      try {
        task_(index, worker);
      } catch (...) {
        next_ = count_;
        keep(std::current_exception(), index);
      }
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void keep(std::exception_ptr failure, std::size_t index) {
    const std::lock_guard lock(mutex_);
    if (failure_ && failed_ < index) return;
    failure_ = std::move(failure);
    failed_ = index;
  }

  std::size_t count_;
  const Task& task_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::size_t failed_ = 0;
};

}  // namespace

unsigned thread_count(unsigned wanted) {
  return wanted > 0 ? wanted
                    : std::max(1U, std::thread::hardware_concurrency());
}

void for_each_task(std::size_t count, std::size_t threads, const Task& task) {
  WorkQueue queue(count, task);
  {
    std::vector<std::jthread> others;
    const std::size_t wanted = std::min(threads, count);
    others.reserve(wanted);
    try {
      for (std::size_t worker = 1; worker < wanted; ++worker)
        others.emplace_back([&queue, worker] { queue.work(worker); });
    } catch (const std::system_error&) {
      // The system grants no more threads; fewer do the same work.
    }
    queue.work(0);
  }
  queue.rethrow();
}

}  // namespace beamgyro::internal
