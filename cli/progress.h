// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "include/beamgyro/progress.h"

namespace beamgyro::internal {

/// Estimates how long work still takes, from its speed over the last half of
/// the time. So a slow start or a change of speed is forgotten, and the
/// estimate converges as the work goes on.
class TimeLeft {
 public:
  /// Notes that `share` of the work (0 .. 1) is done `elapsed` seconds after
  /// its start. Both never fall from one call to the next.
  void note(double elapsed, double share);

  /// Returns the seconds left, or nothing before the work has advanced.
  std::optional<double> seconds() const;

 private:
  struct Sample {
    double elapsed, share;
  };
  std::deque<Sample> samples_ = {{0, 0}};  // the last half, and one before it
};

/// Returns a duration as h:mm:ss.
std::string clock_text(double seconds);

/// Shows progress on standard error while the object lives. On a terminal this
/// is one line, no wider than the terminal, that rewrites itself; it begins
/// after two seconds and is removed at the end. Elsewhere it is a line a
/// minute. With --quiet there is none.
class Progress {
 public:
  /// Share of the work that is done, 0 .. 1, and further text for the line. A
  /// share of 0 shows neither percents nor the time left.
  struct Status {
    double share = 0;
    std::string detail = {};
  };

  explicit Progress(std::string activity);
  /// Another thread calls `status`.
  Progress(std::string activity, std::function<Status()> status);
  ~Progress();

  /// Sets the share of the work that is done, 0 .. 1.
  void set_share(double share) { share_ = share; }
  /// Returns what does so; this object must outlive it.
  beamgyro::Progress shown_share() {
    return [this](double share) {
      set_share(share);
      return true;
    };
  }

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  void draw();
  void log();
  bool over_within(double seconds);
  std::string line(std::size_t width);

  std::string activity_;
  std::function<Status()> status_;
  std::atomic<double> share_ = 0;
  std::chrono::steady_clock::time_point start_;
  TimeLeft left_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
  std::thread thread_;  // last: starts when everything else is there
};

}  // namespace beamgyro::internal
