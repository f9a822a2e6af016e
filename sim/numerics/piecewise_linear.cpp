// SPDX-License-Identifier: MIT
#include "sim/numerics/piecewise_linear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace beamgyro::internal {
namespace {

void require_points(const std::vector<double>& time,
                    const std::vector<double>& value) {
  if (time.empty()) {
    throw std::invalid_argument("a profile needs at least one point");
  }
  if (time.size() != value.size()) {
    throw std::invalid_argument(fmt::format(
        "a profile has {} times and {} values", time.size(), value.size()));
  }
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!std::isfinite(time[i]) || !std::isfinite(value[i])) {
      throw std::invalid_argument(
          fmt::format("point {} of a profile is ({}, {}); both must be finite",
                      i + 1, time[i], value[i]));
    }
    if (i >= 1 && time[i] < time[i - 1]) {
      throw std::invalid_argument(
          fmt::format("time {} s at point {} of a profile comes after {} s; "
                      "times must not decrease",
                      time[i], i + 1, time[i - 1]));
    }
    if (i >= 2 && time[i] == time[i - 2]) {
      throw std::invalid_argument(
          fmt::format("three points of a profile stand at {} s; two make a "
                      "jump",
                      time[i]));
    }
  }
}

}  // namespace

double LinearStretch::at(double t) const {
  return std::lerp(start_value, end_value, (t - start) / (end - start));
}

PiecewiseLinear::PiecewiseLinear(std::vector<double> time,
                                 std::vector<double> value)
    : time_(std::move(time)), value_(std::move(value)) {
  require_points(time_, value_);
}

PiecewiseLinear PiecewiseLinear::constant(double value) {
  return PiecewiseLinear({0.0}, {value});
}

// Value at `t` on the piece that ends at point `next`.
double PiecewiseLinear::between(std::size_t next, double t) const {
  if (next == 0) return value_.front();
  if (next == time_.size()) return value_.back();
  const double start = time_[next - 1], end = time_[next];
  return std::lerp(value_[next - 1], value_[next], (t - start) / (end - start));
}

double PiecewiseLinear::value(double t) const {
  const auto next = std::upper_bound(time_.begin(), time_.end(), t);
  return between(static_cast<std::size_t>(next - time_.begin()), t);
}

double PiecewiseLinear::value_before(double t) const {
  const auto next = std::lower_bound(time_.begin(), time_.end(), t);
  return between(static_cast<std::size_t>(next - time_.begin()), t);
}

std::vector<double> PiecewiseLinear::sample(
    std::span<const double> times) const {
  std::vector<double> values;
  values.reserve(times.size());
  auto next = static_cast<std::size_t>(
      times.empty() ? 0
                    : std::upper_bound(time_.begin(), time_.end(), times[0]) -
                          time_.begin());
  for (const double t : times) {
    while (next < time_.size() && time_[next] <= t) ++next;
    if (next == time_.size()) break;
    values.push_back(between(next, t));
  }
  values.resize(times.size(), value_.back());
  return values;
}

LinearStretch PiecewiseLinear::stretch(double start, double end) const {
  return {start, end, value(start), value_before(end)};
}

std::vector<Border> PiecewiseLinear::borders() const {
  std::vector<Border> borders;
  borders.reserve(time_.size());
  for (std::size_t i = 0; i < time_.size(); ++i) {
    if (i > 0 && time_[i] == time_[i - 1]) {
      borders.back().jump = value_[i] != value_[i - 1];
    } else {
      borders.push_back({time_[i]});
    }
  }
  return borders;
}

}  // namespace beamgyro::internal
