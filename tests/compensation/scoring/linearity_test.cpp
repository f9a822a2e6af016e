// SPDX-License-Identifier: MIT
#include "compensation/scoring/linearity.h"

#include <gtest/gtest.h>

#include <vector>

namespace beamgyro::internal::linearity_test {
namespace {

// Answers at -100, -80, ... 100 deg/s.
Linearity of(double (*law)(double)) {
  std::vector<HeldRate> table;
  for (int k = -5; k <= 5; ++k) table.push_back({20.0 * k, law(20.0 * k)});
  return linearity_of(table);
}

TEST(Linearity, OfAStraightLineIsZero) {
  const Linearity found = of([](double r) { return 2.0 - 0.9 * r; });
  EXPECT_NEAR(found.nonlinearity, 0.0, 1e-8);
  EXPECT_NEAR(found.asymmetry, 0.0, 1e-8);
  EXPECT_NEAR(found.slope, -0.9, 1e-12);
}

TEST(Linearity, OfAParabolaIsItsDistanceFromTheMeanSquare) {
  // V = Omega + e Omega^2: the line is Omega + e mean(Omega^2), mean 4000 for
  // 0, 20, ... 100; furthest off at 100, by e (10000 - 4000).
  const Linearity found = of([](double r) { return r + 1e-6 * r * r; });
  EXPECT_NEAR(found.nonlinearity, 1e6 * 1e-6 * 6000.0 / 100.0, 1e-6);
}

TEST(Linearity, AsymmetryIsTheDifferenceOfTheSlopesOfBothSides) {
  const Linearity found =
      of([](double r) { return r > 0.0 ? 1.001 * r : 0.999 * r; });
  EXPECT_NEAR(found.asymmetry, 2000.0, 1e-6);
}

TEST(Linearity, ATableHasFiveRatesAndTwoOnEachSide) {
  EXPECT_TRUE(is_rate_table(
      std::vector<HeldRate>{{-2, 0}, {-1, 0}, {0, 0}, {1, 0}, {2, 0}}));
  EXPECT_FALSE(
      is_rate_table(std::vector<HeldRate>{{-2, 0}, {-1, 0}, {1, 0}, {2, 0}}));
  EXPECT_FALSE(is_rate_table(
      std::vector<HeldRate>{{-1, 0}, {0, 0}, {1, 0}, {2, 0}, {3, 0}}));
}

}  // namespace
}  // namespace beamgyro::internal::linearity_test
