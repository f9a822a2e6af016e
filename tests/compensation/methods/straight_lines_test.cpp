// SPDX-License-Identifier: MIT
#include "compensation/methods/straight_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/compensation/rows_of.h"

namespace beamgyro::internal::straight_lines_test {
namespace {

double bias(double T, int) { return T * T; }

TEST(StraightLines, AreThroughTheMeansOfSoaksAndLeaveOutRamps) {
  // Soaks of 6 min, with 0.1 K of noise in one; a ramp of 2 K/min between.
  const auto lines = fit_straight_lines(rows_of({{0, 0, 9.9, 10.1, 6},
                                                 {0, 0, 12.0, 28.0, 9},
                                                 {0, 0, 30.0, 30.0, 6},
                                                 {1, 1, 20.0, 20.0, 6}},
                                                bias));
  ASSERT_TRUE(lines.has_value());
  ASSERT_EQ(lines->temperatures.size(), 3);
  EXPECT_NEAR(lines->temperatures(0), 10.0, 1e-12);
  EXPECT_NEAR(lines->values(1), 400.0, 1e-12);
  EXPECT_NEAR(lines->at(25.0), 650.0, 1e-9);
}

TEST(StraightLines, SoaksAtOneTemperatureAreOneEntry) {
  // Once on the way down and once on the way up, 0.4 K apart.
  const auto lines = fit_straight_lines(rows_of(
      {{0, 0, 10.0, 10.0, 6}, {0, 0, 50.0, 50.0, 6}, {0, 0, 10.4, 10.4, 6}},
      [](double, int row) { return row < 6 ? 1.0 : 3.0; }));
  ASSERT_TRUE(lines.has_value());
  ASSERT_EQ(lines->temperatures.size(), 2);
  EXPECT_NEAR(lines->temperatures(0), 10.2, 1e-12);
  EXPECT_NEAR(lines->values(0), 2.0, 1e-12);
}

TEST(StraightLines, ThereAreNoneWithoutTwoSoaks) {
  // A ramp, one as slow as a soak's settling, one soak, soaks of 3 min, and
  // soaks that are one only because the power was off between them.
  for (const std::vector<Leg>& legs : std::vector<std::vector<Leg>>{
           {{0, 0, -40.0, 50.0, 180}},
           {{0, 0, 10.0, 30.0, 400}},
           {{0, 0, 10.0, 10.0, 60}, {0, 0, 10.5, 50.0, 80}},
           {{0, 0, 10.0, 10.0, 4}, {0, 0, 20.0, 20.0, 4}},
           {{0, 0, 10.0, 10.0, 3},
            {0, 1, 10.0, 10.0, 3},
            {0, 2, 20.0, 20.0, 9}}})
    EXPECT_FALSE(fit_straight_lines(rows_of(legs, bias)).has_value())
        << legs.front().to;
}

}  // namespace
}  // namespace beamgyro::internal::straight_lines_test
