// SPDX-License-Identifier: MIT
#include "sensitivity/study/sensitivity_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/sensitivity/indices/sampled_function.h"

namespace beamgyro::internal::sensitivity_study_test {
namespace {

constexpr std::size_t kRows = 1024;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A product of powers: its logarithm is a line with slopes 1, 3 and 2.
double product(const std::vector<double>& u) {
  return std::exp(u[0] + 3 * u[1] + 2 * u[2]);
}

DeviceSample product_sample() {
  DeviceSample sample;
  const IndependentSample independent =
      independent_sample(product, 3, kRows, 1);
  MeritSample merit{sampled(product, 3, kRows, 1), independent.values, {}};
  for (const char* key : {"one", "three", "two"}) {
    sample.factors.push_back({key, {sample.factors.size()}});
    sample.keys.emplace_back(key);
    sample.numbers.emplace_back(independent.numbers.col(
        static_cast<Eigen::Index>(sample.numbers.size())));
    merit.halved.push_back(merit.design.a);
  }
  merit.halved[0].clear();  // a choice
  for (double& value : merit.halved[1]) value *= 0.5;
  sample.merits = {merit};
  sample.devices = 6 * kRows;
  return sample;
}

TEST(SensitivityStudy, FactorsStandInTheOrderOfTheirTotalIndices) {
  const MeritResult result =
      analysed(product_sample(), 0, {Merit::kBiasPeakToPeak, true}, 1);
  ASSERT_EQ(result.factors.size(), 3U);
  const char* keys[] = {"three", "two", "one"};
  const double shares[] = {9. / 14, 4. / 14, 1. / 14};
  for (std::size_t i = 0; i < 3; ++i) {
    const FactorResult& factor = result.factors[i];
    EXPECT_EQ(factor.key, keys[i]);
    EXPECT_NEAR(factor.total.value, shares[i], 0.01);
    EXPECT_NEAR(factor.first.value, shares[i], 0.01);
    // One sigma of the rank estimator is about 1/sqrt(kRows) = 0.03.
    EXPECT_NEAR(factor.first_by_rank.value, shares[i], 0.09);
  }
  EXPECT_NEAR(result.sum_of_first, 1, 0.01);
  EXPECT_NEAR(result.variance, 14. / 12, 0.02);
  EXPECT_NEAR(result.quantiles[1], std::exp(3), 1);
}

TEST(SensitivityStudy, AValueThatHasNoLogarithmCountsAsNone) {
  DeviceSample sample = product_sample();
  sample.merits[0].design.a[3] = 0;
  sample.merits[0].design.b[4] = kNone;
  EXPECT_EQ(analysed(sample, 0, {Merit::kBiasPeakToPeak, true}, 1).rows,
            kRows - 2);
  EXPECT_EQ(analysed(sample, 0, {Merit::kBiasPeakToPeak, false}, 1).rows,
            kRows - 1);
}

TEST(SensitivityStudy, TheYieldCountsMagnitudesAndWhatDoesNotWorkAsBad) {
  DeviceSample sample = product_sample();
  MeritSample& merit = sample.merits[0];
  for (double& value : merit.design.a) value = -1;
  merit.design.a[0] = kNone;
  merit.design.a[1] = 3;
  const YieldResult yield =
      *analysed(sample, 0, {Merit::kWarmUpChange, false, 2.0}, 1).yield;
  EXPECT_EQ(yield.as_is.value, static_cast<double>(kRows - 2) / kRows);
  ASSERT_EQ(yield.halved.size(), 3U);
  EXPECT_EQ(yield.halved.back().key, "one");  // a choice stands last
  EXPECT_FALSE(yield.halved.back().share);
  // e^(u0 + 3 u1 + 2 u2) / 2 is below 2 more often than without the half.
  EXPECT_EQ(yield.halved[0].key, "three");
  EXPECT_GT(yield.halved[0].share->value, yield.halved[1].share->value);
}

TEST(SensitivityStudy, NoDeviceThatWorksIsAnError) {
  DeviceSample sample = product_sample();
  std::ranges::fill(sample.merits[0].design.b, kNone);
  sample.first_failure = "the loop cannot lock";
  EXPECT_THROW(analysed(sample, 0, {Merit::kBiasPeakToPeak, true}, 1),
               std::runtime_error);
}

}  // namespace
}  // namespace beamgyro::internal::sensitivity_study_test
