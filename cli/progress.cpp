// SPDX-License-Identifier: MIT
#include "cli/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPatience = 2, kStep = 0.2, kMinute = 60;  // [s]
constexpr std::size_t kShortest = 12, kLogWidth = 200;      // [characters]

}  // namespace

void TimeLeft::note(double elapsed, double share) {
  samples_.push_back({elapsed, share});
  while (samples_.size() > 2 && samples_[1].elapsed <= elapsed / 2)
    samples_.pop_front();
}

std::optional<double> TimeLeft::seconds() const {
  const Sample &first = samples_.front(), &last = samples_.back();
  const double done = last.share - first.share;
  if (!(done > 0)) return {};
  return (1 - last.share) * (last.elapsed - first.elapsed) / done;
}

std::string clock_text(double seconds) {
  const auto whole = static_cast<long>(std::floor(seconds));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60,
                     whole % 60);
}

Progress::Progress(std::string activity)
    : Progress(std::move(activity), [this] {
        return Status{share_, {}};
      }) {}

Progress::Progress(std::string activity, std::function<Status()> status)
    : activity_(std::move(activity)),
      status_(std::move(status)),
      start_(Clock::now()) {
  try {
    if (shows_progress()) {
      thread_ = std::thread([this] { draw(); });
    } else if (!is_quiet()) {
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

// When the line is too long the last details are left out, then the name of the
// activity is cut off.
std::string Progress::line(std::size_t width) {
  const double elapsed =
      std::chrono::duration<double>(Clock::now() - start_).count();
  const Status status = status_();
  left_.note(elapsed, status.share);
  std::string text;
  if (status.share > 0) text += fmt::format(", {:.0f} %", 100 * status.share);
  text += ", " + clock_text(elapsed);
  if (const std::optional<double> left = left_.seconds())
    text += fmt::format(", {} left", clock_text(*left));
  std::string detail = status.detail;
  const std::size_t name = std::min(activity_.size(), kShortest);
  while (name + text.size() + 2 + detail.size() > width && !detail.empty()) {
    const std::size_t comma = detail.rfind(", ");
    detail.resize(comma == detail.npos ? 0 : comma);
  }
  if (!detail.empty()) text += ", " + detail;
  const std::size_t room =
      width > text.size() + kShortest ? width - text.size() : kShortest;
  return shortened(activity_, room) + text;
}

void Progress::draw() {
  double wait = kPatience;
  while (!over_within(wait)) {
    print_progress(line(terminal_width() - 1));
    wait = kStep;
  }
  if (wait == kStep) print_progress("");
}

// A work that ends while this thread wakes up has its line as well.
void Progress::log() {
  const std::chrono::duration<double> minute(kMinute);
  Clock::time_point last = start_;
  for (bool is_over = false; !is_over;) {
    is_over = over_within(kMinute);
    if (Clock::now() - last < minute) continue;
    print_note(line(kLogWidth));
    last = Clock::now();
  }
}

}  // namespace beamgyro::internal
