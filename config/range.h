// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace beamgyro::internal {

/// Allowed interval of a number; an infinite end is no limit.
struct Range {
  double low, high;
  bool low_open = false, high_open = false;  // end itself not allowed

  bool contains(double value) const;  // false for nan and infinities
};

Range any();                             // every finite number
Range positive();                        // (0, inf)
Range non_negative();                    // [0, inf)
Range between(double low, double high);  // [low, high]

/// Describes the range for messages: "a number > 0", "a number in [0, 1)".
std::string text_of(const Range& range);

}  // namespace beamgyro::internal
