// SPDX-License-Identifier: MIT
#include "statistics/intervals.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cstddef>

namespace beamgyro::internal {

Interval clopper_pearson(double successes, double trials) {
  using Binomial = boost::math::binomial_distribution<double>;
  return {Binomial::find_lower_bound_on_p(trials, successes, kIntervalTail),
          Binomial::find_upper_bound_on_p(trials, successes, kIntervalTail)};
}

double student_half_width(double freedom, std::size_t count) {
  const boost::math::students_t_distribution<double> student(freedom);
  return quantile(
      complement(student, kIntervalTail / static_cast<double>(count)));
}

double percentile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] +
         (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace beamgyro::internal
