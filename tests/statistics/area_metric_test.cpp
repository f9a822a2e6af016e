// SPDX-License-Identifier: MIT
#include "statistics/area_metric.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "random/random_stream.h"

namespace beamgyro::internal::area_metric_test {
namespace {

using Values = std::vector<double>;

std::vector<double> normal_numbers(std::size_t count, std::uint32_t run) {
  RandomStream stream(1, 0, run, kWhiteNoiseStream);
  std::vector<double> values(count);
  stream.fill_normal(values);
  return values;
}

}  // namespace

TEST(AreaMetric, OfTwoSamplesIsTheShiftBetweenThem) {
  const Values sample = {3, -1, 4, 1.5};
  EXPECT_EQ(area_metric(sample, sample), 0);
  for (const double shift : {0.25, -7.0}) {
    Values moved = sample;
    for (double& value : moved) value += shift;
    EXPECT_NEAR(area_metric(sample, moved), std::abs(shift), 1e-14);
  }
}

TEST(AreaMetric, OfTwoSamplesIsTheAreaBetweenTheirSteps) {
  EXPECT_EQ(area_metric(Values{2}, Values{5}), 3);
  // F - G is 1/2 from 0 to 1, 0 to 2, then -1/2 to 4.
  EXPECT_EQ(area_metric(Values{0, 4}, Values{1, 2}), 1.5);
  // 1/3 from 0 to 1, 1/3 - 1/2 to 2, 2/3 - 1/2 to 3.
  EXPECT_NEAR(area_metric(Values{0, 2, 3}, Values{1, 3}),
              1. / 3 + 1. / 6 + 1. / 6, 1e-15);
  EXPECT_EQ(area_metric(Values{1, 1, 1}, Values{1}), 0);
  // The same distribution in samples of other sizes.
  EXPECT_EQ(area_metric(Values{1, 2}, Values{1, 1, 2, 2}), 0);
}

// Equal means and standard deviations sigma and s: the mean of
// |sigma - s| |z|, |sigma - s| sqrt(2/pi).
TEST(AreaMetric, OfScaledSamplesIsThatOfTheScales) {
  const Values sample = normal_numbers(20000, 0);
  Values wide = sample;
  for (double& value : wide) value *= 1.5;
  // The mean |z| of 20,000 numbers is known to 0.6 / sqrt(20000).
  EXPECT_NEAR(area_metric(sample, wide), 0.5 * std::sqrt(2 / M_PI),
              4 * 0.5 * 0.6 / std::sqrt(20000));
}

TEST(AreaMetric, OfATableIsTheShiftFromIt) {
  constexpr std::array kShares = {0.0, 0.25, 0.5, 1.0};
  constexpr std::array kValues = {0.0, 1.0, 2.0, 4.0};
  const TabulatedQuantiles table{kShares, kValues};
  const Values sample = {0, 1, 2, 3, 4};
  EXPECT_NEAR(area_metric(sample, table), 0, 1e-15);
  EXPECT_NEAR(area_metric(Values{0.5, 1.5, 2.5, 3.5, 4.5}, table), 0.5, 1e-15);
  // Straight lines that cross in the middle: mean |2 - 4 p| = 1.
  EXPECT_NEAR(area_metric(Values{2}, table), 1, 1e-15);
  // They cross within a step: triangles of 1/4 by 1 and of 3/4 by 3.
  constexpr std::array kEnds = {0.0, 1.0}, kLowAndHigh = {0.0, 4.0};
  EXPECT_NEAR(area_metric(Values{1}, TabulatedQuantiles{kEnds, kLowAndHigh}),
              0.5 * (0.25 + 2.25), 1e-15);
  // A straight line of the table between 0.5 and 1, bent in the sample: 2 to 4
  // against 2, 2, 4 is a triangle of height 1 over half of the shares.
  EXPECT_NEAR(area_metric(Values{0, 1, 2, 2, 4}, table), 0.25, 1e-15);
}

TEST(AreaMetric, OfATableLeavesOutWhatLiesBeyondIt) {
  constexpr std::array kShares = {0.05, 0.95};
  constexpr std::array kValues = {1.0, 19.0};
  Values sample;
  for (int k = 0; k <= 20; ++k) sample.push_back(k);
  EXPECT_NEAR(area_metric(sample, TabulatedQuantiles{kShares, kValues}), 0,
              1e-14);
  sample.front() = -1e6;
  sample.back() = 1e6;
  EXPECT_NEAR(area_metric(sample, TabulatedQuantiles{kShares, kValues}), 0,
              1e-14);
  // All of the table, moved: no less than the shift, although it ends at 5 %.
  for (double& value : sample) value += 2;
  EXPECT_NEAR(area_metric(sample, TabulatedQuantiles{kShares, kValues}), 2,
              1e-14);
}

TEST(HalfSplit, OfTwoValuesIsTheirDistance) {
  const HalfSplit found = half_split(Values{3, 7}, 20, 1);
  EXPECT_EQ(found.median, 4);
  EXPECT_EQ(found.p95, 4);
}

// Of 0, 0, 1, 1 a third of the splits have each kind on one side, distance 1,
// the others one of each on both, distance 0.
TEST(ManyDrawsHalfSplit, DrawsEverySplitEquallyOften) {
  std::size_t apart = 0;
  constexpr std::size_t kSeeds = 3000;
  for (std::size_t seed = 0; seed < kSeeds; ++seed)
    if (half_split(Values{0, 0, 1, 1}, 1, seed).median == 1) ++apart;
  const double sigma = std::sqrt(kSeeds * (1. / 3) * (2. / 3));
  EXPECT_NEAR(static_cast<double>(apart), kSeeds / 3., 4 * sigma);
}

// Between distribution functions of n1 and n2 normal numbers the mean area is
// sqrt(2/pi) sqrt(1/n1 + 1/n2) times the integral of sqrt(F (1 - F)), which is
// that of two samples of those sizes drawn anew.
TEST(HalfSplit, IsTheDistanceOfTwoSamplesOfThatSize) {
  const HalfSplit halves = half_split(normal_numbers(800, 5), 400, 2);
  Values areas;
  for (std::uint32_t run = 0; run < 400; ++run)
    areas.push_back(area_metric(normal_numbers(400, 100 + 2 * run),
                                normal_numbers(400, 101 + 2 * run)));
  std::ranges::sort(areas);
  // The splits know one sample, whose spread is known to 1 / sqrt(1600); the
  // median of 400 draws to 5 % of it.
  EXPECT_NEAR(halves.median / areas[200], 1, 0.15);
  EXPECT_NEAR(halves.p95 / areas[380], 1, 0.25);
}

TEST(HalfSplit, IsTheSameAgainAndOtherwiseForAnotherSeed) {
  const Values sample = normal_numbers(77, 3);
  EXPECT_EQ(half_split(sample, 100, 1).p95, half_split(sample, 100, 1).p95);
  EXPECT_NE(half_split(sample, 100, 1).p95, half_split(sample, 100, 2).p95);
}

}  // namespace beamgyro::internal::area_metric_test
