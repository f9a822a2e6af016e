// SPDX-License-Identifier: MIT
#include "dataset/set/set_lock.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <thread>
#include <vector>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/child_process.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::set_lock_test {
namespace {

using Lock = DirectoryFixture;

TEST_F(Lock, ASecondStartIsToldWhoIsThere) {
  {
    const SetLock lock(directory, "");
    EXPECT_EQ(lock.dead_holder(), "");
    const std::string message =
        rejection<std::runtime_error>([&] { SetLock(directory, ""); });
    EXPECT_EQ(message, directory.string() + ": in use by host " + host_name() +
                           ", process " + std::to_string(getpid()));
  }
  EXPECT_TRUE(names().empty());
  SetLock(directory, "");
}

TEST_F(Lock, TasksExcludeThemselvesAndWorkOnTheWhole) {
  {
    const SetLock first(directory, "1-of-2");
    const SetLock second(directory, "2-of-2");
    EXPECT_THROW(SetLock(directory, "1-of-2"), std::runtime_error);
    EXPECT_THROW(SetLock(directory, ""), std::runtime_error);
    SetLock(directory, "3-of-3");
    EXPECT_THROW(SetLock(directory, ""), std::runtime_error);
  }
  EXPECT_TRUE(names().empty());
  const SetLock whole(directory, "");
  EXPECT_THROW(SetLock(directory, "1-of-2"), std::runtime_error);
}

/// A process that locks, says so and never ends by itself.
pid_t locking_process(const std::filesystem::path& directory,
                      const std::string& task) {
  int ends[2];
  if (pipe(ends) != 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    const SetLock lock(directory, task);
    if (write(ends[1], "x", 1) == 1) pause();
    _exit(1);
  }
  char ready = 0;
  EXPECT_EQ(read(ends[0], &ready, 1), 1);
  close(ends[0]);
  close(ends[1]);
  return child;
}

TEST_F(Lock, TheLockOfADeadProcessIsTakenOver) {
  for (const char* task : {"", "1-of-2"}) {
    const pid_t child = locking_process(directory, task);
    EXPECT_THROW(SetLock(directory, task), std::runtime_error);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const SetLock lock(directory, task);
    EXPECT_EQ(lock.dead_holder(),
              "host " + host_name() + ", process " + std::to_string(child));
  }
  EXPECT_TRUE(names().empty());
}

TEST_F(Lock, OfTwentyStartsExactlyOneWins) {
  for (int round = 0; round < 5; ++round) {
    int start[2], done[2];
    ASSERT_EQ(pipe(start), 0);
    ASSERT_EQ(pipe(done), 0);
    std::vector<pid_t> children;
    for (int i = 0; i < 20; ++i) {
      children.push_back(fork());
      if (children.back() != 0) continue;
      close(start[1]);
      close(done[1]);
      char byte = 0;
      if (read(start[0], &byte, 1) != 0) _exit(2);
      try {
        const SetLock lock(directory, "");
        // Held until all have had their turn.
        if (read(done[0], &byte, 1) != 0) _exit(2);
        _exit(0);
      } catch (const std::runtime_error&) {
        _exit(1);
      }
    }
    close(start[0]);
    close(start[1]);
    close(done[0]);
    int losers = 0, status = 0;
    while (losers < 19 && wait(&status) > 0)
      losers += WIFEXITED(status) && WEXITSTATUS(status) == 1;
    EXPECT_EQ(losers, 19);
    close(done[1]);
    ASSERT_GT(wait(&status), 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
}

// Every holder removes the file that the next ones have open already.
TEST_F(Lock, NeverTwoAtOnceWhileItComesAndGoes) {
  std::atomic<int> inside{0}, worst{0}, wins{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&] {
        for (int n = 0; n < 1000; ++n) {
          try {
            const SetLock lock(directory, "");
            const int now = ++inside;
            if (now > worst) worst = now;
            ++wins;
            std::this_thread::yield();
            --inside;
          } catch (const std::runtime_error&) {
          }
        }
      });
    }
  }
  EXPECT_EQ(worst, 1);
  EXPECT_GT(wins, 0);
  EXPECT_TRUE(names().empty());
}

// Who leaves last has the shared lock alone while it removes the file.
TEST_F(Lock, TasksThatComeAndGoNeverRefuseEachOther) {
  std::atomic<int> refused{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i <= 4; ++i) {
      threads.emplace_back([&, i] {
        for (int n = 0; n < 200; ++n) {
          try {
            SetLock(directory, std::to_string(i) + "-of-4");
          } catch (const std::runtime_error&) {
            ++refused;
          }
        }
      });
    }
  }
  EXPECT_EQ(refused, 0);
  EXPECT_TRUE(names().empty());
}

TEST_F(Lock, ALockThatIsSomebodyElsesFileIsNotTouched) {
  const std::filesystem::path set = directory / "set";
  std::filesystem::create_directory(set);
  const std::filesystem::path victim = directory / "victim";
  write_text_file(victim, "victim");
  for (const std::string task : {"", "1-of-2"}) {
    const std::filesystem::path lock =
        set / (task.empty() ? "set.lock" : task + ".lock");
    std::filesystem::create_symlink("../victim", lock);
    EXPECT_THROW(SetLock(set, task), std::runtime_error);
    std::filesystem::remove(lock);
    std::filesystem::create_hard_link(victim, lock);
    EXPECT_THROW(SetLock(set, task), std::runtime_error);
    std::filesystem::remove(lock);
    ASSERT_EQ(mkfifo(lock.c_str(), 0666), 0);
    EXPECT_THROW(SetLock(set, task), std::runtime_error);
    std::filesystem::remove(lock);
    SetLock(set, task);
    EXPECT_EQ(read_text_file(victim), "victim");
  }
}

TEST_F(Lock, WithoutFlockTheLivingOfThisHostAreRespected) {
  const auto holds = [&](const std::string& who, const std::string& task) {
    write_text_file(directory / (task.empty() ? "set.lock" : task + ".lock"),
                    who);
    return status_of_child([&] {
      // The file systems of that process have no flock.
      if (!forbid_call(SYS_flock, EOPNOTSUPP)) return 2;
      try {
        const SetLock lock(directory, task);
        const bool is_right =
            !lock.is_held_by_kernel() && lock.dead_holder() == who;
        return is_right ? 0 : 3;
      } catch (const std::runtime_error&) {
        return 1;
      }
    });
  };
  const pid_t dead = dead_process();
  const std::string here = "host " + host_name() + ", process ";
  for (const char* task : {"", "1-of-2"}) {
    EXPECT_EQ(holds(here + std::to_string(getpid()), task), 1) << task;
    EXPECT_EQ(holds(here + std::to_string(dead), task), 0) << task;
    EXPECT_EQ(holds("host elsewhere, process 1", task), 0) << task;
    EXPECT_EQ(holds("", task), 0) << task;
  }
}

TEST_F(Lock, AMissingDirectoryIsNamed) {
  const std::filesystem::path none = directory / "none";
  EXPECT_EQ(rejection<std::runtime_error>([&] { SetLock(none, ""); }),
            (none / "set.lock").string() +
                ": cannot lock: No such file or directory");
}

}  // namespace
}  // namespace beamgyro::internal::set_lock_test
