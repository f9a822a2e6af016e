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

/// While it lives, and once two seconds have passed, a line on standard error
/// tells what is going on and for how long; gone at the end. Only on a terminal
/// and not when quiet.
class Progress {
 public:
  /// How much is done, 0 .. 1, and what else there is to tell.
  struct Status {
    double share;
    std::string detail;
  };

  explicit Progress(std::string activity);
  /// Long work: `status` is asked from another thread, and where there is no
  /// terminal a plain line is printed once a minute.
  Progress(std::string activity, std::function<Status()> status);
  ~Progress();

  /// How much of the work is done, 0 .. 1; shown with what is left.
  void set_share(double share) { share_ = share; }

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  void show();
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
