// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace beamgyro {

/// A time at which an input bends or jumps.
struct Border {
  double time;        // [s]
  bool jump = false;  // not only its slope changes there
};

/// Whether two times [s] differ by no more than the rounding of sums and
/// quotients that mean the same time: 1e-9 s, beyond 70,000 s in proportion.
bool is_same_time(double a, double b);

/// A stretch of time in which every input is smooth: an input is its right-hand
/// limit at `start` and its left-hand limit at `end`.
struct Piece {
  double start, end;  // [s]
  bool jump;          // an input jumps at its start
};

/// The pieces of [0, end] between the `borders` inside, which come in any
/// order. Borders at the same time (is_same_time()) are one: the piece before
/// them ends at the first, the piece after them starts at the last, so that an
/// input taken at `start` has made every jump and one taken just before `end`
/// has made none.
std::vector<Piece> pieces_until(double end, std::vector<Border> borders);

}  // namespace beamgyro
