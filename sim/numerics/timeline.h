// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace beamgyro::internal {

/// A time at which an input or its slope jumps.
struct Border {
  double time;        // [s]
  bool jump = false;  // not only its slope changes there
};

/// Returns whether two times [s] differ by no more than the rounding of sums
/// and quotients that stand for the same time: 1e-9 s, and in proportion beyond
/// 70,000 s.
bool is_same_time(double a, double b);

/// A stretch of time in which every input is smooth: an input is its right-hand
/// limit at `start` and its left-hand limit at `end`.
struct Piece {
  double start, end;  // [s]
  bool jump;          // an input jumps at its start
};

/// Divides [0, end] into pieces at the `borders` inside, which may come in any
/// order. Borders at the same time (is_same_time()) count as one: the piece
/// before them ends at the first, the piece after them starts at the last. So
/// an input evaluated at `start` has made every jump, and one evaluated just
/// before `end` has made none.
std::vector<Piece> pieces_until(double end, std::vector<Border> borders);

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
