// SPDX-License-Identifier: MIT
#include "compensation/uncertainty/sigma_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "random/random_stream.h"
#include "tests/compensation/message_of.h"

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

double amplitude(const ResidualRows& rows) {
  return covering_amplitude(rows, RowMask::Constant(rows.size(), true),
                            ArrayXd::Zero(rows.size()),
                            ArrayXd::Ones(rows.size()));
}

BiasSigma flat(double value) {
  BiasSigma sigma;
  sigma.curve = {ArrayXd{{-40.0, 50.0}}, ArrayXd{{value, value}}};
  sigma.growth = {0.1, 0.1};
  return sigma;
}

// (n + 1) 0.9 = 18: of 19 groups the 18th smallest residual.
TEST(CoveringAmplitude, IsTheQuantileOfOneMoreGroup) {
  std::vector<double> residuals;
  for (int k = 1; k <= 19; ++k) residuals.push_back(k % 2 == 0 ? k : -k);
  EXPECT_NEAR(amplitude(soaked(residuals)), 18.0 / kSigmaHalfWidth, 1e-12);
}

TEST(CoveringAmplitude, OfTheFewestGroupsIsTheLargest) {
  EXPECT_NEAR(amplitude(soaked({1, 9, 2, 8, 3, 7, 4, 6, 5})),
              9.0 / kSigmaHalfWidth, 1e-12);
}

// t(0.95, 2) = 2.920 of squares 1 and 49, whose mean is 25.
TEST(CoveringAmplitude, OfFewerGroupsIsWidenedByStudentsT) {
  EXPECT_NEAR(amplitude(soaked({1.0, -7.0})), 5.0 * 2.920 / kSigmaHalfWidth,
              1e-12);
}

TEST(CoveringAmplitude, WeighsGroupsAndNotRows) {
  // Nine groups of one row, and a tenth of a thousand.
  ResidualRows rows = soaked(std::vector<double>(1009, 1.0));
  rows.group.tail(1000).setConstant(9);
  rows.residual.tail(1000).setConstant(0.5);
  EXPECT_NEAR(amplitude(rows), 1.0 / kSigmaHalfWidth, 1e-12);
  rows.residual.head(9).setConstant(0.5);
  rows.residual.tail(1000).setConstant(1.0);
  // 9 of 11 shares are at 0.5, and 0.9 is within the tenth.
  EXPECT_NEAR(amplitude(rows), 1.0 / kSigmaHalfWidth, 1e-12);
}

TEST(CoveringAmplitude, LeavesWhatTheOthersCover) {
  const ResidualRows rows = soaked(std::vector<double>(20, 1.0));
  const RowMask all = RowMask::Constant(20, true);
  const double needed = 1.0 / kSigmaHalfWidth;
  const ArrayXd most = ArrayXd::Constant(20, 0.8 * needed);
  const ArrayXd scale = ArrayXd::Constant(20, 0.1);
  EXPECT_NEAR(covering_amplitude(rows, all, most, scale), 6.0 * needed, 1e-9);
  EXPECT_EQ(covering_amplitude(rows, all, 2.0 * most, scale), 0.0);
}

TEST(CoveringAmplitude, NeedsARow) {
  const ResidualRows rows = soaked({1.0});
  const RowMask none = RowMask::Constant(1, false);
  EXPECT_EQ(message_of([&] {
              covering_amplitude(rows, none, rows.residual, rows.residual);
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

double coverage(const BiasSigma& sigma, const ResidualRows& rows,
                const RowMask& mask) {
  double covered = 0.0, count = 0.0;
  for (Index k = 0; k < rows.size(); ++k) {
    if (!mask(k)) continue;
    count += 1.0;
    if (std::abs(rows.residual(k)) <=
        kSigmaHalfWidth * sigma.at(rows.temperature(k), rows.since_power_on(k),
                                   rows.temperature_rate(k)))
      covered += 1.0;
  }
  return covered / count;
}

// Of 300 groups and 300 others a coverage of 0.9 has a standard deviation of
// sqrt(2 * 0.09 / 300) = 0.024.
TEST(Calibrate, CoversUnseenGroupsOnSoaksRampsAndWarmUps) {
  BiasSigma sigma = flat(1.0);
  const ResidualRows seen = drawn(300, 1), unseen = drawn(300, 2);
  calibrate(sigma, seen);
  EXPECT_EQ(sigma.calibration.groups, 300U);
  EXPECT_EQ(sigma.calibration.by, "device");
  EXPECT_EQ(sigma.calibration.level, kSigmaLevel);
  EXPECT_NEAR(coverage(sigma, unseen, soak_rows(unseen)), 0.9, 0.05);
  EXPECT_NEAR(coverage(sigma, unseen, ramp_rows(unseen)), 0.9, 0.05);
  EXPECT_NEAR(coverage(sigma, unseen, warm_up_rows(unseen)), 0.9, 0.05);
  // Normal residuals: the factor is their deviation.
  EXPECT_NEAR(sigma.factor, 0.2, 0.03);
}

TEST(Calibrate, WithoutRampsAndWarmUpsThereAreNoTermsOfThem) {
  BiasSigma sigma = flat(1.0);
  calibrate(sigma, soaked(std::vector<double>(12, 0.3)));
  EXPECT_FALSE(sigma.temperature_rate);
  EXPECT_FALSE(sigma.power_on);
  EXPECT_NEAR(sigma.factor, 0.3 / kSigmaHalfWidth, 1e-12);
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
  EXPECT_NEAR(sigma.factor, 0.4 / kSigmaHalfWidth, 1e-12);
  EXPECT_FALSE(sigma.temperature_rate);
}

}  // namespace
}  // namespace beamgyro::internal::sigma_calibration_test
