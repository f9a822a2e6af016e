// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace beamgyro {

/// Prints a line of progress on standard error while the object lives,
/// beginning after two seconds, and removes it at the end. It prints on a
/// terminal only, and nothing with --quiet.
class Progress {
 public:
  /// Share of the work that is done, 0 .. 1, and further text for the line.
  struct Status {
    double share;
    std::string detail;
  };

  explicit Progress(std::string activity);
  /// For long work: another thread calls `status`. Where there is no terminal a
  /// plain line is printed once a minute.
  Progress(std::string activity, std::function<Status()> status);
  ~Progress();

  /// Sets the share of the work that is done, 0 .. 1. The line shows it with
  /// the time left.
  void set_share(double share) { share_ = share; }

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  void draw();
  void log();
  bool over_within(double seconds);
  std::string line() const;

  std::string activity_;
  std::function<Status()> status_;
  std::atomic<double> share_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
  std::thread thread_;  // last: starts when everything else is there
};

}  // namespace beamgyro
