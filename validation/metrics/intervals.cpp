// SPDX-License-Identifier: MIT
#include "validation/metrics/intervals.h"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace beamgyro::internal {

Interval clopper_pearson(double successes, double trials) {
  using Binomial = boost::math::binomial_distribution<double>;
  return {Binomial::find_lower_bound_on_p(trials, successes, kIntervalTail),
          Binomial::find_upper_bound_on_p(trials, successes, kIntervalTail)};
}

double student_half_width(double freedom) {
  const boost::math::students_t_distribution<double> student(freedom);
  return quantile(complement(student, kIntervalTail));
}

}  // namespace beamgyro::internal
