// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace beamgyro::internal {

/// The times k / rate of samples k = 0 .. count - 1.
struct SampleGrid {
  double rate;        // [Hz]
  std::size_t count;  // samples

  double time(std::size_t k) const { return static_cast<double>(k) / rate; }

  /// Returns the times of `n` samples, beginning with sample `first`.
  std::vector<double> times(std::size_t first, std::size_t n) const;

  /// Returns the index of the first sample at or after `t` [s], or `count` when
  /// there is none.
  std::size_t first_from(double t) const;
};

}  // namespace beamgyro::internal
