// SPDX-License-Identifier: MIT
#include "statistics/intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace beamgyro::internal::intervals_test {
namespace {

// Returns the probability of `low` to `high` successes in `n` trials.
double probability(std::size_t n, double p, std::size_t low, std::size_t high) {
  double sum = 0.0;
  for (std::size_t k = low; k <= high; ++k) {
    const auto count = static_cast<double>(n), hits = static_cast<double>(k);
    sum += std::exp(std::lgamma(count + 1) - std::lgamma(hits + 1) -
                    std::lgamma(count - hits + 1) + hits * std::log(p) +
                    (count - hits) * std::log1p(-p));
  }
  return sum;
}

}  // namespace

// At each end the observation, or a more extreme one, has probability 2.5 %.
TEST(ClopperPearson, EndsLeaveATailOfTwoAndAHalfPercent) {
  for (const auto& [k, n] : {std::pair<std::size_t, std::size_t>{1, 10},
                             {7, 10},
                             {95, 100},
                             {523, 1000}}) {
    const Interval interval =
        clopper_pearson(static_cast<double>(k), static_cast<double>(n));
    EXPECT_NEAR(probability(n, interval.low, k, n), 0.025, 1e-9) << k;
    EXPECT_NEAR(probability(n, interval.high, 0, k), 0.025, 1e-9) << k;
  }
}

TEST(ClopperPearson, OfNoneAndOfAllReachesTheEnd) {
  const Interval none = clopper_pearson(0, 20);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 1 - std::pow(0.025, 1.0 / 20), 1e-12);
  const Interval all = clopper_pearson(20, 20);
  EXPECT_NEAR(all.low, std::pow(0.025, 1.0 / 20), 1e-12);
  EXPECT_EQ(all.high, 1.0);
}

// Tables of t(0.975).
TEST(StudentHalfWidth, IsThatOfTables) {
  EXPECT_NEAR(student_half_width(1.0), 12.706, 5e-4);
  EXPECT_NEAR(student_half_width(9.0), 2.262, 5e-4);
  EXPECT_NEAR(student_half_width(1e6), 1.960, 5e-4);
}

TEST(Percentile, LiesOnStraightLinesBetweenTheSortedValues) {
  const std::vector<double> sorted = {-1, 0, 2, 5};
  EXPECT_EQ(percentile(sorted, 0), -1);
  EXPECT_EQ(percentile(sorted, 0.5), 1);
  EXPECT_NEAR(percentile(sorted, 0.9), 4.1, 1e-12);
  EXPECT_EQ(percentile(sorted, 1), 5);
  EXPECT_EQ(percentile({3}, 0.95), 3);
}

}  // namespace beamgyro::internal::intervals_test
