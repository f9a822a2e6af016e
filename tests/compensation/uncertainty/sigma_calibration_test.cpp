// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/sigma_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "random/random_stream.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::sigma_calibration_test {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

// One row per group, on a soak long after power-on.
ResidualRows soaked(const std::vector<double>& residuals) {
  const auto count = static_cast<Index>(residuals.size());
  ResidualRows rows;
  rows.temperature = ArrayXd::Constant(count, 20.0);
  rows.residual = Eigen::Map<const ArrayXd>(residuals.data(), count);
  rows.since_power_on = rows.temperature_rate = ArrayXd::Zero(count);
  rows.group = Eigen::ArrayXi::LinSpaced(count, 0, static_cast<int>(count) - 1);
  rows.by = "device";
  return rows;
}

RowMask all_of(const ResidualRows& rows) {
  return RowMask::Constant(rows.size(), true);
}

double amplitude(const ResidualRows& rows) {
  return mean_square_amplitude(rows, all_of(rows), ArrayXd::Zero(rows.size()),
                               ArrayXd::Ones(rows.size()));
}

double half_width(const ResidualRows& rows) {
  return conformal_half_width(rows, ArrayXd::Ones(rows.size()));
}

BiasSigma flat(double value) {
  BiasSigma sigma;
  sigma.curve = {ArrayXd{{-40.0, 50.0}}, ArrayXd{{value, value}}};
  sigma.growth = {0.1, 0.1};
  return sigma;
}

// (n + 1) 0.9 = 18: of 19 groups the 18th smallest residual.
TEST(ConformalHalfWidth, IsTheQuantileOfOneMoreGroup) {
  std::vector<double> residuals;
  for (int k = 1; k <= 19; ++k) residuals.push_back(k % 2 == 0 ? k : -k);
  EXPECT_EQ(half_width(soaked(residuals)), 18.0);
  EXPECT_EQ(conformal_half_width(soaked(residuals), ArrayXd::Constant(19, 2.0)),
            9.0);
}

TEST(ConformalHalfWidth, OfTheFewestGroupsIsTheLargestAndOfFewerThereIsNone) {
  EXPECT_EQ(half_width(soaked({1, 9, 2, 8, 3, 7, 4, 6, 5})), 9.0);
  EXPECT_EQ(half_width(soaked({1, 2, 8, 3, 7, 4, 6, 5})), 0.0);
}

TEST(ConformalHalfWidth, WeighsGroupsAndNotRows) {
  // Nine groups of one row, and a tenth of a thousand.
  ResidualRows rows = soaked(std::vector<double>(1009, 1.0));
  rows.group.tail(1000).setConstant(9);
  rows.residual.tail(1000).setConstant(0.5);
  EXPECT_EQ(half_width(rows), 1.0);
  rows.residual.head(9).setConstant(0.5);
  rows.residual.tail(1000).setConstant(1.0);
  // 9 of 11 shares are at 0.5, and 0.9 is within the tenth.
  EXPECT_EQ(half_width(rows), 1.0);
}

TEST(MeanSquareAmplitude, IsTheRootMeanSquareOfGroups) {
  EXPECT_NEAR(amplitude(soaked({1, -7, 1, 7, 1, 7, -1, 7, 1, 7})), 5.0, 1e-9);
  // A group of two rows counts as one.
  ResidualRows rows = soaked({3, 3, 3, 3, 3, 3, 3, 3, 1, 7});
  rows.group(9) = rows.group(8);
  EXPECT_NEAR(amplitude(rows), std::sqrt((8 * 9.0 + 25.0) / 9.0), 1e-9);
}

// t(0.95, 2) = 2.920 over 1.645 of squares 1 and 49, whose mean is 25.
TEST(MeanSquareAmplitude, OfFewerGroupsIsWidenedByStudentsT) {
  EXPECT_NEAR(amplitude(soaked({1.0, -7.0})), 5.0 * 2.91999 / 1.64485, 1e-4);
}

// Two runs of 90 K, over which residuals forget themselves nine times each:
// t(0.95, 18) = 1.734.
TEST(MeanSquareAmplitude, CountsWhatARunForgets) {
  ResidualRows rows = soaked({1.0, 1.0, -7.0, 7.0});
  rows.group << 0, 0, 1, 1;
  rows.temperature << -40.0, 50.0, -40.0, 50.0;
  rows.correlation = 10.0;
  EXPECT_NEAR(amplitude(rows), 5.0 * 1.73406 / 1.64485, 1e-4);
}

TEST(MeanSquareAmplitude, IsWhatTheOthersLeave) {
  const ResidualRows rows = soaked(std::vector<double>(20, 1.0));
  const ArrayXd others = ArrayXd::Constant(20, 0.8);
  const ArrayXd scale = ArrayXd::Constant(20, 0.1);
  EXPECT_NEAR(mean_square_amplitude(rows, all_of(rows), others, scale), 6.0,
              1e-8);
  EXPECT_EQ(mean_square_amplitude(rows, all_of(rows), 1.3 * others, scale),
            0.0);
}

// Where scales differ, the mean of z^2 is 1 and not that of the squares.
TEST(MeanSquareAmplitude, MakesTheMeanOfNormalisedSquaresOne) {
  const ResidualRows rows = soaked({1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  const ArrayXd others = ArrayXd::LinSpaced(10, 1.0, 4.0);
  const ArrayXd scale = ArrayXd::LinSpaced(10, 2.0, 0.1);
  const double a = mean_square_amplitude(rows, all_of(rows), others, scale);
  EXPECT_NEAR(
      (rows.residual.square() / (others.square() + (a * scale).square()))
          .mean(),
      1.0, 1e-9);
}

TEST(MeanSquareAmplitude, NeedsARow) {
  const ResidualRows rows = soaked({1.0});
  const RowMask none = RowMask::Constant(1, false);
  EXPECT_EQ(rejection([&] {
              mean_square_amplitude(rows, none, rows.residual, rows.residual);
            }),
            "no rows to calibrate a sigma on");
}

// Groups of 30 rows whose residuals share a normal offset, a lag a_g r on half
// of the rows and a warm-up on some.
ResidualRows drawn(int groups, std::uint32_t stream) {
  constexpr int kRows = 30;
  RandomStream random(5, 0, stream, RandomPurpose{0});
  ResidualRows rows = soaked(
      std::vector<double>(static_cast<std::size_t>(groups * kRows), 0.0));
  for (Index k = 0; k < rows.size(); k += kRows) {
    const double offset = 0.2 * random.normal(), lag = 20.0 * random.normal();
    const double warm = 0.5 * random.normal();
    for (Index i = 0; i < kRows; ++i) {
      rows.group(k + i) = static_cast<int>(k / kRows);
      rows.temperature_rate(k + i) = i % 2 == 0 ? 0.0 : 0.02;
      rows.since_power_on(k + i) =
          i < 10 ? std::exp(-0.3 * static_cast<double>(i)) : 0.0;
      rows.residual(k + i) = offset + lag * rows.temperature_rate(k + i) +
                             warm * rows.since_power_on(k + i);
    }
  }
  return rows;
}

// Of residuals over sigma: the mean square, and the share within some.
struct Normalised {
  double mean_square = 0.0, within = 0.0;
};

Normalised normalised(const BiasSigma& sigma, const ResidualRows& rows,
                      const RowMask& mask, double half_width) {
  Normalised found;
  double count = 0.0;
  for (Index k = 0; k < rows.size(); ++k) {
    if (!mask(k)) continue;
    const double z =
        rows.residual(k) / sigma.at(rows.temperature(k), rows.since_power_on(k),
                                    rows.temperature_rate(k));
    count += 1.0;
    found.mean_square += z * z;
    if (std::abs(z) <= half_width) found.within += 1.0;
  }
  return {found.mean_square / count, found.within / count};
}

// Of 300 groups and 300 others a share of 0.9 has a standard deviation of
// sqrt(2 * 0.09 / 300) = 0.024, and a mean square of sqrt(4 / 300) = 0.12.
TEST(Calibrate, IsTheStandardDeviationOnSoaksRampsAndWarmUps) {
  BiasSigma sigma = flat(1.0);
  const ResidualRows seen = drawn(300, 1), unseen = drawn(300, 2);
  calibrate(sigma, seen);
  EXPECT_EQ(sigma.calibration.groups, 300U);
  EXPECT_EQ(sigma.calibration.by, "device");
  EXPECT_EQ(sigma.calibration.level, kSigmaLevel);
  // Normal residuals: the factor is their deviation.
  EXPECT_NEAR(sigma.factor, 0.2, 0.03);
  EXPECT_NEAR(sigma.calibration.half_width, 1.645, 0.15);
  for (const auto& rows_of : {soak_rows, ramp_rows, warm_up_rows}) {
    EXPECT_NEAR(normalised(sigma, seen, rows_of(seen), 1.0).mean_square, 1.0,
                1e-6);
    const Normalised found = normalised(sigma, unseen, rows_of(unseen),
                                        sigma.calibration.half_width);
    EXPECT_NEAR(found.mean_square, 1.0, 0.3);
    EXPECT_NEAR(found.within, 0.9, 0.05);
  }
}

// Of a few devices unlike all others the mean square takes notice. Their
// tails are what the half-width tells beside it.
TEST(Calibrate, OfLongTailsTheHalfWidthIsNotTheNormalOne) {
  std::vector<double> residuals(95, 0.1);
  residuals.insert(residuals.end(), 5, 2.0);
  BiasSigma sigma = flat(1.0);
  calibrate(sigma, soaked(residuals));
  EXPECT_NEAR(sigma.factor, std::sqrt(0.95 * 0.01 + 0.05 * 4.0), 1e-9);
  EXPECT_NEAR(sigma.calibration.half_width, 0.1 / sigma.factor, 1e-9);
}

TEST(Calibrate, WithoutRampsAndWarmUpsThereAreNoTermsOfThem) {
  BiasSigma sigma = flat(1.0);
  calibrate(sigma, soaked(std::vector<double>(12, 0.3)));
  EXPECT_FALSE(sigma.temperature_rate);
  EXPECT_FALSE(sigma.power_on);
  EXPECT_NEAR(sigma.factor, 0.3, 1e-12);
}

TEST(Calibrate, ResidualsOfNothingKeepTheFactor) {
  BiasSigma sigma = flat(0.1);
  calibrate(sigma, soaked(std::vector<double>(12, 0.0)));
  EXPECT_EQ(sigma.factor, 1.0);
}

TEST(Calibrate, RowsOfRampsAloneCalibrateTheFactor) {
  BiasSigma sigma = flat(1.0);
  ResidualRows rows = soaked(std::vector<double>(12, 0.4));
  rows.temperature_rate.setConstant(0.02);
  calibrate(sigma, rows);
  EXPECT_NEAR(sigma.factor, 0.4, 1e-12);
  ASSERT_TRUE(sigma.temperature_rate);
  EXPECT_EQ(sigma.temperature_rate->amplitude, 0.0);
}

}  // namespace
}  // namespace beamgyro::internal::sigma_calibration_test
