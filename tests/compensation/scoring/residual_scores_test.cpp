// SPDX-License-Identifier: MIT
#include "compensation/scoring/residual_scores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace beamgyro::internal::residual_scores_test {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

TEST(ResidualScores, AreTheScoresOfKnownBlockMeans) {
  const std::vector<double> blocks{1.0, -3.0, 5.0, 1.0};
  const ResidualScores scores = residual_scores(blocks);
  EXPECT_EQ(scores.blocks, 4U);
  EXPECT_DOUBLE_EQ(scores.mean, 1.0);
  EXPECT_DOUBLE_EQ(scores.variance, 8.0);  // (0 + 16 + 16 + 0) / 4
  EXPECT_DOUBLE_EQ(scores.sigma, std::sqrt(8.0));
  EXPECT_DOUBLE_EQ(scores.rms, 3.0);  // (1 + 9 + 25 + 1) / 4 = 9
  EXPECT_DOUBLE_EQ(scores.peak_to_peak, 8.0);
  EXPECT_DOUBLE_EQ(scores.largest, 5.0);
}

TEST(ResidualScores, AConstantOffsetIsAllMeanAndNoVariance) {
  const std::vector<double> blocks(20, -0.25);
  const ResidualScores scores = residual_scores(blocks);
  EXPECT_EQ(scores.mean, -0.25);
  EXPECT_EQ(scores.variance, 0.0);
  EXPECT_EQ(scores.peak_to_peak, 0.0);
  EXPECT_EQ(scores.rms, 0.25);
  EXPECT_EQ(scores.largest, 0.25);
}

TEST(ResidualScores, ALineOverTimeHasTheVarianceOfItsBlockMeans) {
  // n equally spaced means d apart: variance d^2 (n^2 - 1) / 12.
  std::vector<double> blocks;
  for (int i = 0; i < 11; ++i) {
    blocks.push_back(3.0 + 0.5 * i);
  }
  EXPECT_NEAR(residual_scores(blocks).variance, 0.25 * 120.0 / 12.0, 1e-14);
}

TEST(ResidualScores, BlocksAverageTheDifferenceFromTheTruth) {
  const std::vector<SampleRange> blocks{{0, 2}, {3, 5}};
  const std::vector<double> rate{1.0, 2.0, 100.0, 4.0, 8.0};
  const std::vector<double> truth{0.5, 0.5, 0.0, 1.0, 1.0};
  EXPECT_THAT(block_residuals(blocks, rate, truth),
              ElementsAre(DoubleEq(1.0), DoubleEq(5.0)));
}

TEST(ResidualScores, AMissingAnswerLeavesNoScore) {
  const std::vector<double> blocks{0.1, std::nan(""), 0.2};
  const ResidualScores scores = residual_scores(blocks);
  EXPECT_EQ(scores.blocks, 3U);
  for (const double score : {scores.mean, scores.variance, scores.sigma,
                             scores.rms, scores.peak_to_peak, scores.largest}) {
    EXPECT_TRUE(std::isnan(score));
  }
}

TEST(ResidualScores, RefuseNoBlockAtAll) {
  EXPECT_THROW(residual_scores({}), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::residual_scores_test
