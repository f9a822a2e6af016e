// SPDX-License-Identifier: MIT
#include "compensation/models/lookup_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/compensation/bias_curve.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::lookup_table_test {
namespace {

using Eigen::ArrayXd;

ArrayXd numbers(std::initializer_list<double> values) {
  ArrayXd result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

TEST(LookupTable, IsStraightBetweenItsTemperaturesAndFlatBeyond) {
  const LookupTable table{numbers({-10.0, 0.0, 30.0}),
                          numbers({1.0, 3.0, 0.0})};
  EXPECT_EQ(table.at(-10.0), 1.0);
  EXPECT_EQ(table.at(-2.5), 2.5);
  EXPECT_EQ(table.at(0.0), 3.0);
  EXPECT_EQ(table.at(20.0), 1.0);
  EXPECT_EQ(table.at(30.0), 0.0);
  EXPECT_EQ(table.at(-60.0), 1.0);
  EXPECT_EQ(table.at(85.0), 0.0);
  EXPECT_TRUE(
      (table.predict(numbers({-2.5, 20.0, 99.0})) == numbers({2.5, 1.0, 0.0}))
          .all());
}

TEST(LookupTable, OfOneTemperatureIsAConstant) {
  const LookupTable table{numbers({25.0}), numbers({0.7})};
  for (const double T : {-40.0, 25.0, 85.0}) EXPECT_EQ(table.at(T), 0.7);
}

TEST(LookupTable, BinsHoldTheMeansOfTheirPointsBelowZeroToo) {
  // Bins [-5, 0), [0, 5), none in [5, 10), [10, 15).
  const LookupTable table =
      fit_lookup_table(numbers({14.0, -1.0, 0.0, -4.0, 3.0, 10.0}),
                       numbers({6.0, 1.0, 2.0, 3.0, 4.0, 8.0}), 5.0);
  EXPECT_TRUE((table.temperatures == numbers({-2.5, 1.5, 12.0})).all())
      << table.temperatures.transpose();
  EXPECT_TRUE((table.values == numbers({2.0, 3.0, 7.0})).all())
      << table.values.transpose();
}

TEST(LookupTable, OfAStraightLineIsThatLineWithinItsTemperatures) {
  const ArrayXd T = grid(-40.0, 50.0, 0.37);
  const LookupTable table = fit_lookup_table(T, 0.3 - 0.02 * T, 5.0);
  const ArrayXd inside = grid(-37.0, 47.0, 0.5);
  EXPECT_LT((table.predict(inside) - (0.3 - 0.02 * inside)).abs().maxCoeff(),
            1e-14);
}

// Means and chords of a parabola c T^2 over bins of width h are off by at most
// c h^2 (1 / 12 + 1 / 4).
TEST(LookupTable, ErrorOfAParabolaFallsWithTheSquareOfTheWidth) {
  const ArrayXd T = grid(-40.0, 40.0, 0.01), b = 1e-3 * T.square();
  const ArrayXd inside = grid(-30.0, 30.0, 0.25);
  for (const double width : {10.0, 5.0, 2.5}) {
    const double worst =
        (fit_lookup_table(T, b, width).predict(inside) - 1e-3 * inside.square())
            .abs()
            .maxCoeff();
    const double bound = 1e-3 * width * width * (1.0 / 12.0 + 1.0 / 4.0);
    EXPECT_LT(worst, 1.02 * bound) << width;
    EXPECT_GT(worst, 0.9 * bound) << width;
  }
}

TEST(LookupTable, NeedsPointsAndAWidth) {
  const ArrayXd T = numbers({1.0, 2.0});
  EXPECT_TRUE(holds(rejection([&] { fit_lookup_table(T, T, 0.0); }),
                    "2 points in bins of 0 K"));
  EXPECT_THROW(fit_lookup_table(T, T, NAN), std::invalid_argument);
  EXPECT_THROW(fit_lookup_table(ArrayXd(), ArrayXd(), 5.0),
               std::invalid_argument);
}

// The soak at 0 lies on both sides of a border of bins.
TEST(LookupTable, AtSoaksHasOneEntryForEachSoakWhereverItLies) {
  const ArrayXd x = numbers({-0.1, 20.0, 0.1, -20.2, 20.2, -19.8});
  const ArrayXd y = numbers({1.0, 5.0, 3.0, -1.0, 7.0, -3.0});
  const LookupTable table = fit_table_at_soaks(x, y, 5.0);
  EXPECT_TRUE(table.temperatures.isApprox(numbers({-20.0, 0.0, 20.1}), 1e-14))
      << table.temperatures.transpose();
  EXPECT_TRUE((table.values == numbers({-2.0, 2.0, 6.0})).all())
      << table.values.transpose();
  EXPECT_EQ(fit_lookup_table(x, y, 5.0).values.size(), 5);
}

TEST(LookupTable, AtSoaksRefusesARamp) {
  const ArrayXd T = grid(-40.0, 40.0, 1.0);
  EXPECT_TRUE(
      holds(rejection([&] { fit_table_at_soaks(T, T, 5.0); }),
            "temperatures from -40.00 to -34.00 degC are a ramp, a table at "
            "soaks needs soaks within 5 K; set rows.steady_K_per_min"));
  EXPECT_THROW(fit_table_at_soaks(T, T, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::lookup_table_test
