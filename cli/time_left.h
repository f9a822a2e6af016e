// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>
#include <string>

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

}  // namespace beamgyro::internal
