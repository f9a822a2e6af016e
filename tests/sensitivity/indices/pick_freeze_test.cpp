// SPDX-License-Identifier: MIT
#include "sensitivity/indices/pick_freeze.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "random/random_stream.h"
#include "tests/sensitivity/indices/sampled_function.h"

namespace beamgyro::internal::pick_freeze_test {
namespace {

constexpr std::size_t kRows = 2048;

void expect_inside(const IndexEstimate& index, double exact) {
  EXPECT_GE(exact, index.low);
  EXPECT_LE(exact, index.high);
  // An interval that holds everything would show nothing.
  EXPECT_LT(index.high - index.low, 0.25);
}

TEST(PickFreezeIndices, OfIshigamisFunctionLieInTheirIntervals) {
  // V = a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2 with a = 7, b = 0.1; V_1 =
  // (1 + b pi^4/5)^2 / 2, V_2 = a^2/8, V_13 = 8 b^2 pi^8 / 225.
  const double first[] = {0.3139, 0.4424, 0};
  const double total[] = {0.5576, 0.4424, 0.2437};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const PickFreezeIndices indices =
        pick_freeze_indices(sampled(ishigami, 3, kRows, seed), seed);
    EXPECT_EQ(indices.rows, kRows);
    EXPECT_NEAR(indices.variance, 13.845, 0.1);  // 1/sqrt(kRows) is 2 %
    for (std::size_t i = 0; i < 3; ++i) {
      expect_inside(indices.factors[i].first, first[i]);
      expect_inside(indices.factors[i].total, total[i]);
      EXPECT_NEAR(indices.factors[i].total_by_product, total[i], 0.1);
    }
  }
}

TEST(PickFreezeIndices, OfTheGFunctionLieInTheirIntervals) {
  // V_i = 1 / (3 (1 + a_i)^2), V = product of (1 + V_i) less 1.
  double product = 1;
  std::vector<double> own;
  for (const double a : kGImportance) {
    own.push_back(1 / (3 * (1 + a) * (1 + a)));
    product *= 1 + own.back();
  }
  const PickFreezeIndices indices =
      pick_freeze_indices(sampled(g_function, own.size(), kRows, 4), 4);
  for (std::size_t i = 0; i < own.size(); ++i) {
    expect_inside(indices.factors[i].first, own[i] / (product - 1));
    expect_inside(indices.factors[i].total,
                  own[i] * product / (1 + own[i]) / (product - 1));
  }
}

// How often the intervals hold in samples of many seeds.
TEST(ManyDrawsPickFreeze, IntervalsOfStrongInteractionsHold) {
  // x1 + x1 x2 + 0.3 x3 of normal numbers: V_1 = V_12 = 1, V_3 = 0.09.
  const auto f = [](const std::vector<double>& u) {
    const double x1 = normal_quantile(u[0]), x2 = normal_quantile(u[1]);
    return x1 + x1 * x2 + 0.3 * normal_quantile(u[2]);
  };
  const double first[] = {1 / 2.09, 0, 0.09 / 2.09};
  const double total[] = {2 / 2.09, 1 / 2.09, 0.09 / 2.09};
  constexpr std::size_t kSeeds = 200, kFewRows = 512;
  int first_held[3] = {}, total_held[3] = {};
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const PickFreezeIndices indices =
        pick_freeze_indices(sampled(f, 3, kFewRows, seed), seed);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto holds = [](const IndexEstimate& index, double exact) {
        return index.low <= exact && exact <= index.high ? 1 : 0;
      };
      first_held[i] += holds(indices.factors[i].first, first[i]);
      total_held[i] += holds(indices.factors[i].total, total[i]);
    }
  }
  // 95 % of 200 are 190, less three standard deviations 181. Sobol' points err
  // less than the independent rows of the intervals.
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GE(first_held[i], 181) << i;
    EXPECT_GE(total_held[i], 181) << i;
  }
}

TEST(PickFreezeIndices, ALineHasTheSharesOfItsSlopesAndNoInteraction) {
  const auto line = [](const std::vector<double>& u) {
    return 1000 + 3 * u[0] - 4 * u[1];
  };
  const PickFreezeIndices indices =
      pick_freeze_indices(sampled(line, 3, kRows, 5), 5);
  const double share[] = {0.36, 0.64, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(indices.factors[i].first.value, share[i], 0.01);
    EXPECT_NEAR(indices.factors[i].total.value, share[i], 0.01);
  }
  EXPECT_EQ(indices.factors[2].total.high, 0);  // exactly: it is not there
}

TEST(PickFreezeIndices, ARowWithoutAValueCountsWhereItCan) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  PickFreezeValues values = sampled(ishigami, 3, kRows, 6);
  values.a[0] = kNone;
  values.b[1] = kNone;
  values.ab[2][2] = kNone;
  values.ab[2][0] = kNone;  // counts once
  const PickFreezeIndices indices = pick_freeze_indices(values, 6);
  EXPECT_EQ(indices.rows, kRows - 2);
  EXPECT_EQ(indices.factors[0].rows, kRows - 2);
  EXPECT_EQ(indices.factors[2].rows, kRows - 3);
  // As without these rows; only factor 2 had a row more.
  PickFreezeValues shorter;
  const auto kept = [](const std::vector<double>& all) {
    return std::vector<double>(all.begin() + 2, all.end());
  };
  shorter.a = kept(values.a);
  shorter.b = kept(values.b);
  for (const std::vector<double>& ab : values.ab)
    shorter.ab.push_back(kept(ab));
  const PickFreezeIndices same = pick_freeze_indices(shorter, 6);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(indices.factors[i].total.value, same.factors[i].total.value);
    EXPECT_EQ(indices.factors[i].first.low, same.factors[i].first.low);
  }
}

TEST(PickFreezeIndices, WhatDoesNotVaryHasIndicesOfZero) {
  const auto constant = [](const std::vector<double>&) { return 0.1; };
  const PickFreezeIndices indices =
      pick_freeze_indices(sampled(constant, 2, 64, 7), 7);
  EXPECT_EQ(indices.variance, 0);
  for (const FactorIndices& factor : indices.factors) {
    EXPECT_EQ(factor.first.value, 0);
    EXPECT_EQ(factor.total.high, 0);
  }
  PickFreezeValues nothing = sampled(constant, 2, 64, 7);
  for (double& value : nothing.a) value = std::nan("");
  EXPECT_EQ(pick_freeze_indices(nothing, 7).rows, 0U);
}

}  // namespace
}  // namespace beamgyro::internal::pick_freeze_test
