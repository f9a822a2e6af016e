// SPDX-License-Identifier: MIT
#include "cli/progress.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "cli/terminal.h"

namespace beamgyro {

namespace {

std::string line(const std::string& activity, double share, double elapsed) {
  if (share <= 0) return fmt::format("{}, {:.0f} s", activity, elapsed);
  return fmt::format("{}, {:.0f} %, {:.0f} s, {:.0f} s left", activity,
                     100 * share, elapsed, elapsed * (1 - share) / share);
}

}  // namespace

Progress::Progress(std::string activity) : activity_(std::move(activity)) {
  if (shows_progress()) thread_ = std::thread([this] { show(); });
}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void Progress::show() {
  using Clock = std::chrono::steady_clock;
  using std::chrono::milliseconds;
  constexpr milliseconds kPatience(2000), kStep(200);
  const Clock::time_point start = Clock::now();
  std::unique_lock lock(mutex_);
  milliseconds wait = kPatience;
  bool shown = false;
  while (!ended_.wait_for(lock, wait, [this] { return over_; })) {
    const std::chrono::duration<double> elapsed = Clock::now() - start;
    print_progress(line(activity_, share_, elapsed.count()));
    shown = true;
    wait = kStep;
  }
  if (shown) print_progress("");
}

}  // namespace beamgyro
