// SPDX-License-Identifier: MIT
#include "parallel/work_queue.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace beamgyro::internal::work_queue_test {
namespace {

class WorkQueue : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Threads, WorkQueue, testing::Values(0, 1, 2, 7, 300));

TEST_P(WorkQueue, DoesEveryTaskOnce) {
  constexpr std::size_t kTasks = 200;
  std::vector<std::atomic<int>> done(kTasks);
  for_each_task(kTasks, GetParam(),
                [&](std::size_t index, std::size_t) { ++done[index]; });
  for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
}

TEST_P(WorkQueue, GivesAWorkerNoTwoTasksAtOnce) {
  const std::size_t workers = std::max<std::size_t>(GetParam(), 1);
  std::vector<std::atomic<int>> at_work(workers);
  for_each_task(100, GetParam(), [&](std::size_t, std::size_t worker) {
    ASSERT_LT(worker, workers);
    EXPECT_EQ(++at_work[worker], 1);
    std::this_thread::yield();
    --at_work[worker];
  });
}

TEST_P(WorkQueue, RethrowsTheExceptionOfTheLowestTask) {
  for (int repeat = 0; repeat < 20; ++repeat) {
    try {
      for_each_task(100, GetParam(), [&](std::size_t index, std::size_t) {
        // The lowest one fails last.
        if (index == 3)
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (index >= 3) throw std::out_of_range(std::to_string(index));
      });
      ADD_FAILURE() << "no exception";
    } catch (const std::out_of_range& error) {
      EXPECT_STREQ(error.what(), "3");
    }
  }
}

TEST_P(WorkQueue, BeginsNoTaskAfterAnException) {
  std::atomic<int> begun = 0;
  EXPECT_THROW(for_each_task(1000000, GetParam(),
                             [&](std::size_t, std::size_t) {
                               ++begun;
                               throw std::runtime_error("no");
                             }),
               std::runtime_error);
  EXPECT_LE(begun, static_cast<int>(std::max<std::size_t>(GetParam(), 1)));
}

TEST(WorkQueueThreads, RunAtTheSameTime) {
  std::atomic<int> arrived = 0;
  for_each_task(2, 2, [&](std::size_t, std::size_t) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

TEST(WorkQueueThreads, NoTaskNeedsNone) {
  for_each_task(0, 4, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(WorkQueueThreads, AreAsManyAsWantedOrAsThereAreCores) {
  EXPECT_EQ(thread_count(3), 3u);
  EXPECT_GE(thread_count(0), 1u);
}

// In a process of a user who may have no second thread; no limit holds root.
[[noreturn]] void work_alone() {
  constexpr unsigned kUser = 54322;  // of no one else
  const rlimit one{1, 1};
  if (setrlimit(RLIMIT_NPROC, &one) != 0) _exit(2);
  if (geteuid() == 0 && setuid(kUser) != 0) _exit(3);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::size_t done = 0;
  for_each_task(50, 4, [&](std::size_t, std::size_t) {
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
    ++done;
  });
  _exit(done == 50 && threads.size() == 1 ? 0 : 4);
}

TEST(WorkQueueThreads, ThatTheSystemDoesNotGrantAreFewerThreads) {
  EXPECT_EXIT(work_alone(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace beamgyro::internal::work_queue_test
