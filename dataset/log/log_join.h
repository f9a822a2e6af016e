// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dataset/recording/recording.h"

namespace beamgyro::internal {

/// Interpolates the columns of a recording between its samples k and k + 1:
///   x = x_k + (x_{k+1} - x_k) (t - t_k) / (t_{k+1} - t_k).
class JoinedRows {
 public:
  /// `longest_gap` [s] is the longest t_{k+1} - t_k that is interpolated.
  /// Times of the recording are off by at most `rounding` [s].
  JoinedRows(Recording recording, double longest_gap, double rounding);

  /// Sets one value for each column at `time` [s], which must not be before
  /// that of the call before and is off by at most `rounding` [s]. Returns
  /// false, and sets nothing, before the first and after the last sample and
  /// within a longer gap. Times that only rounding keeps apart are equal.
  bool read(double time, double rounding, std::vector<double>& values);

  double begin() const { return recording_.time.front(); }  // [s]
  double end() const { return recording_.time.back(); }     // [s]
  double period() const;  // [s], median of t_{k+1} - t_k

 private:
  Recording recording_;
  double longest_gap_, rounding_;  // [s]
  std::size_t next_ = 0;  // the first sample that is not before the time
};

}  // namespace beamgyro::internal
