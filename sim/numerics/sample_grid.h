// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace beamgyro {

/// The times k / rate of samples k = 0 .. count - 1.
struct SampleGrid {
  double rate;        // [Hz]
  std::size_t count;  // samples

  double time(std::size_t k) const { return static_cast<double>(k) / rate; }

  /// time() of `n` samples from `first` on.
  std::vector<double> times(std::size_t first, std::size_t n) const;

  /// The first sample at or after `t` [s], `count` when there is none.
  std::size_t first_from(double t) const;
};

}  // namespace beamgyro
