// SPDX-License-Identifier: MIT
#include "compensation/rate_injection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/compensation/recorded_run.h"

namespace beamgyro {
namespace {

const RecordedRun kDrifting{
    .duration = 3600.0,
    .step = 0.5,
    .bias = [](double t) { return 1.0 - std::exp(-t / 700.0); },
    .temperature = [](double t) { return 30.0 - 5.0 * std::exp(-t / 700.0); },
    .powered = [](double t) { return t >= 20.0; }};

/// rate - gain u: with gain 1 the network that learnt to answer 0 at rest.
RateEstimator eats(double gain) {
  return [gain](const Recording& run) {
    const auto& output = column_values(run, "output");
    const auto& rate = column_values(run, "rate");
    std::vector<double> answer;
    for (std::size_t k = 0; k < rate.size(); ++k) {
      answer.push_back(rate[k] - gain * (output[k] - 2.5) / 0.0125);
    }
    return answer;
  };
}

std::vector<double> bias_only(const Recording& run) {
  auto answer = column_values(run, "rate");
  const auto& temperature = column_values(run, "temperature");
  for (std::size_t k = 0; k < answer.size(); ++k) {
    answer[k] -= std::tanh(0.2 * (temperature[k] - 25.0));
  }
  return answer;
}

TEST(Verification, V44ABiasOnlyCompensatorKeepsTheScaleFactorToRounding) {
  const auto rho = injected_scale_factor(bias_only, kDrifting.recording());
  ASSERT_TRUE(rho);
  EXPECT_LT(std::abs(*rho - 1.0), 1e-12);
}

TEST(RateInjection, ShowsTheShareOfTheRateThatIsEaten) {
  const Recording run = kDrifting.recording();
  EXPECT_NEAR(*injected_scale_factor(eats(1.0), run), 0.0, 1e-9);
  EXPECT_NEAR(*injected_scale_factor(eats(0.3), run), 0.7, 1e-9);
}

TEST(RateInjection, CatchesAFilterThatForgetsAConstantRate) {
  // rate - slow mean: passes steps, loses a rate held for ten minutes.
  const auto high_pass = [](const Recording& run) {
    auto answer = column_values(run, "rate");
    double slow = std::nan("");
    for (double& rate : answer) {
      if (std::isfinite(rate)) {
        slow = std::isfinite(slow) ? slow + (rate - slow) * 0.5 / 100.0 : rate;
        rate -= slow;
      }
    }
    return answer;
  };
  EXPECT_LT(*injected_scale_factor(high_pass, kDrifting.recording()), 0.5);
}

TEST(RateInjection, MovesOutputAndRateByTheSameRate) {
  const Recording run = kDrifting.recording();
  const auto moved = with_injected_rate(run, 2.0);
  ASSERT_TRUE(moved);
  const auto& before = column_values(run, "rate");
  const auto& rate = column_values(*moved, "rate");
  const auto& output = column_values(*moved, "output");
  EXPECT_TRUE(std::isnan(rate[0]));
  EXPECT_NEAR(rate[100] - before[100], 2.0, 1e-14);
  EXPECT_NEAR(rate[3000] - before[3000], -2.0, 1e-14);
  for (std::size_t k = 100; k < rate.size(); k += 100) {
    EXPECT_NEAR(output[k], 2.5 + 0.0125 * rate[k], 1e-12);
  }
  EXPECT_EQ(column_values(*moved, "temperature")[100],
            column_values(run, "temperature")[100]);
}

TEST(RateInjection, PatternStepsSwingsAndRampsWithinItsAmplitude) {
  EXPECT_EQ(injected_rate(0.0, 0.0, 2.0), 2.0);
  EXPECT_EQ(injected_rate(0.5, 50.0, 2.0), -2.0);
  EXPECT_NEAR(injected_rate(0.7, 65.0, 2.0), 2.0, 1e-12);
  EXPECT_NEAR(injected_rate(0.9, 90.0, 2.0), 0.0, 1e-12);
  EXPECT_NEAR(injected_rate(1.0, 100.0, 2.0), 2.0, 1e-12);
}

TEST(RateInjection, IsMissingWhereTheScaleOfTheOutputCannotBeKnown) {
  const Recording still = RecordedRun{.duration = 60.0}.recording();
  EXPECT_FALSE(injected_scale_factor(bias_only, still));
  Recording log = still;
  log.columns.erase(log.columns.begin());
  EXPECT_NEAR(*injected_scale_factor(bias_only, log), 1.0, 1e-12);
}

TEST(RateInjection, RefusesAnOutputThatIsNoLineOverTheRate) {
  Recording run = kDrifting.recording();
  run.columns[0].values[500] += 0.01;
  EXPECT_THROW(with_injected_rate(run), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro
