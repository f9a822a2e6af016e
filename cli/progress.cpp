// SPDX-License-Identifier: MIT
#include "cli/progress.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "cli/terminal.h"

namespace beamgyro {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPatience = 2, kStep = 0.2, kMinute = 60;  // [s]

}  // namespace

Progress::Progress(std::string activity)
    : Progress(std::move(activity), nullptr) {}

Progress::Progress(std::string activity, std::function<Status()> status)
    : activity_(std::move(activity)),
      status_(std::move(status)),
      start_(Clock::now()) {
  try {
    if (shows_progress()) {
      thread_ = std::thread([this] { draw(); });
    } else if (status_) {
      thread_ = std::thread([this] { log(); });
    }
  } catch (const std::system_error&) {
    // If the system refuses a thread the work runs without a line of progress.
  }
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

bool Progress::over_within(double seconds) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, std::chrono::duration<double>(seconds),
                         [this] { return over_; });
}

std::string Progress::line() const {
  const double elapsed =
      std::chrono::duration<double>(Clock::now() - start_).count();
  const Status status = status_ ? status_() : Status{share_, {}};
  const double share = status.share;
  std::string text = activity_;
  if (share > 0) text += fmt::format(", {:.0f} %", 100 * share);
  text += fmt::format(", {:.0f} s", elapsed);
  if (share > 0)
    text += fmt::format(", {:.0f} s left", elapsed * (1 - share) / share);
  if (!status.detail.empty()) text += ", " + status.detail;
  return text;
}

void Progress::draw() {
  double wait = kPatience;
  while (!over_within(wait)) {
    print_progress(line());
    wait = kStep;
  }
  if (wait == kStep) print_progress("");
}

void Progress::log() {
  while (!over_within(kMinute)) print_note(line());
}

}  // namespace beamgyro
