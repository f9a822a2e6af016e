// SPDX-License-Identifier: MIT
#include "sensitivity/indices/rank_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/sensitivity/indices/sampled_function.h"

namespace beamgyro::internal::rank_index_test {
namespace {

struct Known {
  UnitFunction function;
  std::size_t dimensions;
  std::vector<double> first;  // the index of each of the first factors
};

// V_i = 1 / 3 (1 + a_i)^2 of V = product of 1 + V_i, less 1.
Known known_g_function() {
  double product = 1;
  for (const double a : kGImportance)
    product *= 1 + 1 / (3 * (1 + a) * (1 + a));
  std::vector<double> first;
  for (const double a : {0.0, 1.0, 4.5})
    first.push_back(1 / (3 * (1 + a) * (1 + a)) / (product - 1));
  return {g_function, kGImportance.size(), first};
}

// Three numbers of weights 1, 1/2 and 1/10 and one without any.
Known known_sum() {
  const auto sum = [](const std::vector<double>& u) {
    return u[0] + 0.5 * u[1] + 0.1 * u[2];
  };
  return {sum, 4, {1 / 1.26, 0.25 / 1.26, 0.01 / 1.26, 0}};
}

const Known kIshigami = {ishigami, 3, {0.3139, 0.4424, 0}};

// Of so many samples the share, by factor, whose interval holds the index.
std::vector<double> shares_inside(const Known& known, std::size_t rows,
                                  std::uint64_t seeds) {
  std::vector<double> shares(known.first.size());
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const IndependentSample sample =
        independent_sample(known.function, known.dimensions, rows, seed);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const RankIndex index = rank_index(
          sample.values, sample.numbers.col(static_cast<Eigen::Index>(i)));
      if (index.interval->low <= known.first[i] &&
          known.first[i] <= index.interval->high)
        shares[i] += 1 / static_cast<double>(seeds);
    }
  }
  return shares;
}

TEST(RankIndex, OfIshigamisFunctionLiesInItsInterval) {
  // 95 % less three sigma of 100 draws.
  for (const std::size_t rows : {32u, 256u, 2048u})
    for (const double share : shares_inside(kIshigami, rows, 100))
      EXPECT_GE(share, 0.885) << rows << " rows";
}

TEST(RankIndex, AnIntervalIsAsNarrowAsTheRowsAllow) {
  const IndependentSample sample = independent_sample(ishigami, 3, 2048, 1);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const RankIndex index = rank_index(sample.values, sample.numbers.col(i));
    EXPECT_LT(index.interval->high - index.interval->low, 0.16);
  }
}

TEST(RankIndex, FewRowsAndSeveralNumbersHaveNoInterval) {
  const IndependentSample few = independent_sample(ishigami, 3, 31, 1);
  EXPECT_FALSE(rank_index(few.values, few.numbers.col(0)).interval);
  const IndependentSample sample = independent_sample(ishigami, 3, 500, 1);
  EXPECT_FALSE(rank_index(sample.values, sample.numbers).interval);
}

class RankIndexInterval : public testing::TestWithParam<std::size_t> {};

// 95 % of each, where the sigma of 1000 draws is 0.7 %.
TEST_P(RankIndexInterval, HoldsTheIndex) {
  for (const Known& known : {kIshigami, known_g_function(), known_sum()}) {
    const std::vector<double> shares = shares_inside(known, GetParam(), 1000);
    for (std::size_t i = 0; i < shares.size(); ++i)
      EXPECT_GE(shares[i], 0.93) << "factor " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(ManyDraws, RankIndexInterval,
                         testing::Values(32, 64, 128, 256, 512, 2048));

TEST(RankIndex, OfSeveralNumbersIsThatOfTheirPair) {
  // x1 and x3 together explain all but the part of x2. The nearest of 4096
  // points of a square is 1/128 off, which costs a few per cent of the index.
  const IndependentSample sample = independent_sample(ishigami, 3, 4096, 4);
  Eigen::MatrixXd pair(sample.numbers.rows(), 2);
  pair << sample.numbers.col(0), sample.numbers.col(2);
  EXPECT_NEAR(rank_index(sample.values, pair).value, 1 - 0.4424, 0.04);
}

TEST(RankIndex, ARowWithoutAValueDoesNotCount) {
  IndependentSample sample = independent_sample(ishigami, 3, 500, 5);
  const double whole = rank_index(sample.values, sample.numbers.col(1)).value;
  sample.values.push_back(std::nan(""));
  sample.numbers.conservativeResize(501, Eigen::NoChange);
  sample.numbers.row(500).setConstant(0.5);
  EXPECT_EQ(rank_index(sample.values, sample.numbers.col(1)).value, whole);
}

TEST(RankIndex, WhatDoesNotVaryHasTheIndexZero) {
  const std::vector<double> values(100, 0.1);
  const Eigen::MatrixXd numbers = Eigen::VectorXd::LinSpaced(100, 0, 1);
  EXPECT_EQ(rank_index(values, numbers).value, 0);
  EXPECT_EQ(rank_index({}, Eigen::MatrixXd(0, 1)).value, 0);
}

}  // namespace
}  // namespace beamgyro::internal::rank_index_test
