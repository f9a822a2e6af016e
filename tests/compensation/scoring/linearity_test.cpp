// SPDX-License-Identifier: MIT
#include "compensation/scoring/linearity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::linearity_test {
namespace {

const RecordedRun kTable{
    .duration = 330.0, .step = 0.5, .true_rate = rate_table(100.0, 11, 30.0)};

std::vector<double> answers(const Recording& run, double (*law)(double)) {
  std::vector<double> all;
  for (const double rate : column_values(run, "true_rate")) {
    all.push_back(law(rate));
  }
  return all;
}

TEST(Linearity, OfAStraightLineIsZero) {
  const Recording run = kTable.recording();
  const auto found =
      linearity(run, answers(run, [](double r) { return 2.0 - 0.9 * r; }));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->nonlinearity, 0.0, 1e-8);
  EXPECT_NEAR(found->asymmetry, 0.0, 1e-8);
  EXPECT_EQ(found->rates, 11U);
}

TEST(Linearity, OfAParabolaIsItsDistanceFromTheMeanSquare) {
  // V = Omega + e Omega^2: the line is Omega + e mean(Omega^2), mean 4000 for
  // 0, 20, ... 100; furthest off at 100, by e (10000 - 4000).
  const Recording run = kTable.recording();
  const auto found =
      linearity(run, answers(run, [](double r) { return r + 1e-6 * r * r; }));
  EXPECT_NEAR(found->nonlinearity, 1e6 * 1e-6 * 6000.0 / 100.0, 1e-6);
}

TEST(Linearity, AsymmetryIsTheDifferenceOfTheSlopesOfBothSides) {
  const Recording run = kTable.recording();
  const auto found = linearity(run, answers(run, [](double r) {
                                 return r > 0.0 ? 1.001 * r : 0.999 * r;
                               }));
  EXPECT_NEAR(found->asymmetry, 2000.0, 1e-6);
}

TEST(Linearity, LeavesOutSaturatedSamplesAndTheFirstSecondOfARate) {
  Recording run = kTable.recording();
  auto rate = column_values(run, "rate");
  for (std::size_t k = 0; k < rate.size(); ++k) {
    const bool just_set = k % 60 < 2;
    if (just_set) {
      rate[k] = 7.0;
    }
    if (rate[k] == 100.0) {
      rate[k] = 80.0;
      run.status[k] |= kOutputSaturated;
    }
  }
  const auto found = linearity(run, rate);
  EXPECT_EQ(found->rates, 10U);
  EXPECT_NEAR(found->nonlinearity, 0.0, 1e-8);
}

TEST(Linearity, IsMissingWithoutARateTable) {
  const RecordedRun sine{.true_rate = [](double t) { return std::sin(t); }};
  const Recording run = sine.recording();
  EXPECT_FALSE(linearity(run, column_values(run, "rate")));
  const RecordedRun few{.true_rate = rate_table(50.0, 3, 60.0)};
  const Recording steps = few.recording();
  EXPECT_FALSE(linearity(steps, column_values(steps, "rate")));
}

TEST(Linearity, IsThatOfTheWorstTemperature) {
  RecordedRun two = kTable;
  two.duration = 660.0;
  two.temperature = [](double t) { return t < 330.0 ? -20.0 : 40.0; };
  const Recording run = two.recording();
  auto rate = column_values(run, "rate");
  for (std::size_t k = 660; k < rate.size(); ++k) {
    rate[k] += 1e-6 * rate[k] * rate[k];
  }
  EXPECT_NEAR(linearity(run, rate)->nonlinearity, 60.0, 1e-6);
}

TEST(Linearity, RefusesAnAnswerOfAnotherLength) {
  const Recording run = kTable.recording();
  EXPECT_THROW(linearity(run, std::vector<double>(3, 0.0)),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::linearity_test
