// SPDX-License-Identifier: MIT
#include "sensitivity/indices/rank_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/sensitivity/indices/sampled_function.h"

namespace beamgyro::internal::rank_index_test {
namespace {

TEST(RankIndex, OfIshigamisFunctionLiesInItsInterval) {
  const double first[] = {0.3139, 0.4424, 0};
  constexpr int kSeeds = 40;
  int inside = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const IndependentSample sample =
        independent_sample(ishigami, 3, 2048, seed);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const IndexEstimate index =
          rank_index(sample.values, sample.numbers.col(i), seed,
                     static_cast<std::uint32_t>(i));
      inside += index.low <= first[i] && first[i] <= index.high ? 1 : 0;
      EXPECT_LT(index.high - index.low, 0.16);
    }
  }
  // 95 % of 120 are 114; fewer than 107 would be three sigma.
  EXPECT_GE(inside, 107);
}

TEST(RankIndex, OfSeveralNumbersIsThatOfTheirPair) {
  // x1 and x3 together explain all but the part of x2. The nearest of 4096
  // points of a square is 1/128 off, which costs a few per cent of the index.
  const IndependentSample sample = independent_sample(ishigami, 3, 4096, 4);
  Eigen::MatrixXd pair(sample.numbers.rows(), 2);
  pair << sample.numbers.col(0), sample.numbers.col(2);
  EXPECT_NEAR(rank_index(sample.values, pair, 4, 0).value, 1 - 0.4424, 0.04);
}

TEST(RankIndex, ARowWithoutAValueDoesNotCount) {
  IndependentSample sample = independent_sample(ishigami, 3, 500, 5);
  const double whole =
      rank_index(sample.values, sample.numbers.col(1), 5, 0).value;
  sample.values.push_back(std::nan(""));
  sample.numbers.conservativeResize(501, Eigen::NoChange);
  sample.numbers.row(500).setConstant(0.5);
  EXPECT_EQ(rank_index(sample.values, sample.numbers.col(1), 5, 0).value,
            whole);
}

TEST(RankIndex, WhatDoesNotVaryHasTheIndexZero) {
  const std::vector<double> values(100, 0.1);
  const Eigen::MatrixXd numbers = Eigen::VectorXd::LinSpaced(100, 0, 1);
  EXPECT_EQ(rank_index(values, numbers, 6, 0).value, 0);
  EXPECT_EQ(rank_index({}, Eigen::MatrixXd(0, 1), 6, 0).value, 0);
}

}  // namespace
}  // namespace beamgyro::internal::rank_index_test
