// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace beamgyro::internal {

/// A quantity over time that is known at knots, with cubics between them whose
/// slopes come from the parabola through three knots. At a break the slope may
/// jump. Value is a number or an Eigen array.
template <class Value>
class SmoothCourse {
 public:
  void add(const Value& value) { values_.push_back(value); }
  const std::vector<Value>& values() const { return values_; }

  /// Call once, after the last add(): one time [s] and one mark of a break for
  /// each value.
  void finish(const std::vector<double>& times,
              const std::vector<char>& breaks) {
    const std::size_t count = values_.size();
    after_.assign(count, values_.front() - values_.front());
    before_ = after_;
    for (std::size_t k = 0; k < count; ++k) {
      const bool has_left = k > 0, has_right = k + 1 < count;
      if (has_left && has_right && !breaks[k]) {
        after_[k] = before_[k] = slope(times, k - 1, k);
        continue;
      }
      if (has_right) {
        const bool is_alone = k + 2 >= count || breaks[k + 1];
        after_[k] = is_alone ? secant(times, k)
                             : 2 * secant(times, k) - slope(times, k, k + 1);
      }
      if (has_left) {
        const bool is_alone = k < 2 || breaks[k - 1];
        before_[k] =
            is_alone ? secant(times, k - 1)
                     : 2 * secant(times, k - 1) - slope(times, k - 2, k - 1);
      }
    }
  }

  /// The value at `t` [s] between knots k and k + 1.
  Value at(const std::vector<double>& times, std::size_t k, double t) const {
    const double h = times[k + 1] - times[k], s = (t - times[k]) / h;
    const Value rise = values_[k + 1] - values_[k];
    const Value first = h * after_[k], last = h * before_[k + 1];
    return values_[k] + s * (first + s * (3 * rise - 2 * first - last +
                                          s * (first + last - 2 * rise)));
  }

 private:
  Value secant(const std::vector<double>& times, std::size_t k) const {
    return (values_[k + 1] - values_[k]) / (times[k + 1] - times[k]);
  }
  // At `k`, of the parabola through left, left + 1 = k, k + 1.
  Value slope(const std::vector<double>& times, std::size_t left,
              std::size_t k) const {
    const double a = times[k] - times[left], b = times[k + 1] - times[k];
    return (b * secant(times, left) + a * secant(times, k)) / (a + b);
  }

  std::vector<Value> values_, after_, before_;
};

/// The index k with times[k] <= t < times[k + 1], or that of the first or last
/// interval; `from` is a first guess. There are at least two times.
inline std::size_t interval_of(const std::vector<double>& times, double t,
                               std::size_t from) {
  const std::size_t last = times.size() - 2;
  std::size_t k = std::min(from, last);
  if (t < times[k])
    k = static_cast<std::size_t>(
        std::upper_bound(times.begin(), times.end(), t) - times.begin());
  if (t < times[k] && k > 0) --k;
  while (k < last && t >= times[k + 1]) ++k;
  return std::min(k, last);
}

}  // namespace beamgyro::internal
