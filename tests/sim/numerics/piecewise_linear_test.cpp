// SPDX-License-Identifier: MIT
#include "sim/numerics/piecewise_linear.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/config/rejection.h"

namespace beamgyro::internal::piecewise_linear_test {
namespace {

std::string rejection_of(std::vector<double> time, std::vector<double> value) {
  return rejection([&] { PiecewiseLinear(std::move(time), std::move(value)); });
}

TEST(PiecewiseLinear, IsLinearBetweenItsPointsAndHeldOutside) {
  const PiecewiseLinear profile({10, 20, 40}, {1, 3, -1});
  EXPECT_EQ(profile.value(-5), 1);
  EXPECT_EQ(profile.value(10), 1);
  EXPECT_EQ(profile.value(15), 2);
  EXPECT_EQ(profile.value(20), 3);
  EXPECT_EQ(profile.value(35), 0);
  EXPECT_EQ(profile.value(40), -1);
  EXPECT_EQ(profile.value(1e9), -1);
}

TEST(PiecewiseLinear, HasBothLimitsAtAJump) {
  const PiecewiseLinear profile({0, 0, 1, 1, 2, 2}, {1, 2, 3, 4, 5, 6});
  for (const double t : {0.0, 1.0, 2.0}) {
    EXPECT_EQ(profile.value_before(t), 1 + 2 * t);
    EXPECT_EQ(profile.value(t), 2 + 2 * t);
  }
  EXPECT_EQ(profile.value(0.5), 2.5);
  EXPECT_EQ(profile.value(1.5), 4.5);
}

TEST(PiecewiseLinear, LimitsAgreeWhereNothingJumps) {
  const PiecewiseLinear profile({0, 1, 3}, {0.1, 0.7, -0.2});
  for (const double t : {-1.0, 0.0, 0.3, 1.0, 1.9, 3.0, 4.0}) {
    EXPECT_EQ(profile.value(t), profile.value_before(t)) << "t = " << t;
  }
}

TEST(PiecewiseLinear, SamplesAsItEvaluates) {
  const PiecewiseLinear profile({0, 1, 1, 2.5}, {0.3, 0.7, -1.1, 4.0});
  std::vector<double> times;
  for (int k = -10; k < 40; ++k) times.push_back(0.1 * k);
  times.insert(times.begin() + 20, 1.0);
  std::sort(times.begin(), times.end());
  const std::vector<double> values = profile.sample(times);
  ASSERT_EQ(values.size(), times.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_EQ(values[k], profile.value(times[k])) << "t = " << times[k];
  }
}

TEST(PiecewiseLinear, NamesEachBorderOnceAndWhetherTheValueJumps) {
  const PiecewiseLinear profile({0, 1, 1, 2, 2}, {0, 1, 2, 3, 3});
  const std::vector<Border> borders = profile.borders();
  ASSERT_EQ(borders.size(), 3);
  for (std::size_t i = 0; i < borders.size(); ++i) {
    EXPECT_EQ(borders[i].time, static_cast<double>(i));
    EXPECT_EQ(borders[i].jump, i == 1) << i;
  }
  EXPECT_EQ(PiecewiseLinear::constant(7).value(123), 7);
}

TEST(PiecewiseLinear, RejectsWhatIsNoProfile) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(holds(rejection_of({}, {}), "at least one point"));
  EXPECT_TRUE(holds(rejection_of({0, 1}, {0}), "2 times and 1 values"));
  EXPECT_TRUE(holds(rejection_of({0, nan}, {0, 1}), "point 2"));
  EXPECT_TRUE(holds(rejection_of({0, 1}, {INFINITY, 1}), "point 1"));
  EXPECT_TRUE(holds(rejection_of({0, 2, 1}, {0, 1, 2}), "1 s at point 3"));
  EXPECT_TRUE(holds(rejection_of({0, 2, 2, 2}, {0, 1, 2, 3}), "three points"));
}

}  // namespace
}  // namespace beamgyro::internal::piecewise_linear_test
