// SPDX-License-Identifier: MIT
#include "config/range.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace beamgyro::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  return (low_open ? value > low : value >= low) &&
         (high_open ? value < high : value <= high);
}

Range any() { return {-kInfinity, kInfinity}; }
Range positive() { return {0.0, kInfinity, true, false}; }
Range non_negative() { return {0.0, kInfinity}; }
Range between(double low, double high) { return {low, high}; }

std::string text_of(const Range& range) {
  const bool below = std::isfinite(range.low);
  const bool above = std::isfinite(range.high);
  if (below && above) {
    return fmt::format("a number in {}{}, {}{}", range.low_open ? '(' : '[',
                       range.low, range.high, range.high_open ? ')' : ']');
  }
  if (below) {
    return fmt::format("a number {} {}",
                       range.low_open ? ">" : ">=", range.low);
  }
  if (above) {
    return fmt::format("a number {} {}",
                       range.high_open ? "<" : "<=", range.high);
  }
  return "a finite number";
}

}  // namespace beamgyro::internal
