// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "random/random_stream.h"

namespace beamgyro::internal {

/// The Wiener path W(age) [sqrt(s)] of one device since its factory trim, W(0)
/// = 0: values at two ages differ by a normal of their distance as variance. It
/// is one path for every run of a seed and device, in whatever order the ages
/// are asked for, so a run goes on where an earlier one ended. Drawn by halving
/// intervals of the path (Levy) down to 1 s, with straight lines between.
class WalkSinceTrim {
 public:
  WalkSinceTrim(std::uint64_t seed, std::uint32_t device);

  /// Returns W(age). Fast where the age is near that of the last call. Throws
  /// std::invalid_argument for an age [s] outside 0 .. 2^32.
  double at(double age);

 private:
  struct Interval {
    double start, length;  // [s]
    double first, last;    // W at its ends
    double middle;         // W at its middle, for those that are halved
    std::uint32_t number;  // of its halves: 2 number and 2 number + 1
    bool holds(double age) const {
      return age >= start && age < start + length;
    }
  };
  void push(double start, double length, double first, double last,
            std::uint32_t number);
  double normal(std::uint32_t number) const;

  std::uint64_t seed_;
  std::uint32_t device_;
  std::vector<Interval> path_;  // each but the first is half of the one before
};

}  // namespace beamgyro::internal
