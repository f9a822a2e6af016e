// SPDX-License-Identifier: MIT
#include "sim/signal/walk_since_trim.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "sim/signal/random_purposes.h"

namespace beamgyro::internal {
namespace {

constexpr double kLongestWalk = 0x1p32, kWalkGrid = 1;  // [s]

}  // namespace

WalkSinceTrim::WalkSinceTrim(std::uint64_t seed, std::uint32_t device)
    : seed_(seed), device_(device) {
  push(0, kLongestWalk, 0, std::sqrt(kLongestWalk) * normal(0), 1);
}

double WalkSinceTrim::normal(std::uint32_t number) const {
  return RandomStream(seed_, device_, number, kWalkSinceTrimStream).normal();
}

void WalkSinceTrim::push(double start, double length, double first, double last,
                         std::uint32_t number) {
  double middle = 0;
  if (length > kWalkGrid)
    middle = 0.5 * (first + last) + 0.5 * std::sqrt(length) * normal(number);
  path_.push_back({start, length, first, last, middle, number});
}

double WalkSinceTrim::at(double age) {
  if (!(age >= 0 && age <= kLongestWalk))
    throw std::invalid_argument(
        fmt::format("age is {} s, must be 0 to {}", age, kLongestWalk));
  while (path_.size() > 1 && !path_.back().holds(age)) path_.pop_back();
  while (path_.back().length > kWalkGrid) {
    const Interval i = path_.back();
    const double half = i.length / 2;
    if (age < i.start + half) {
      push(i.start, half, i.first, i.middle, 2 * i.number);
    } else {
      push(i.start + half, half, i.middle, i.last, 2 * i.number + 1);
    }
  }
  const Interval& i = path_.back();
  return i.first + (i.last - i.first) * ((age - i.start) / i.length);
}

}  // namespace beamgyro::internal
