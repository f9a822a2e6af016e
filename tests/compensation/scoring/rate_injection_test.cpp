// SPDX-License-Identifier: MIT
#include "compensation/scoring/rate_injection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/compensation/injected_scale_factor.h"
#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::rate_injection_test {
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

TEST(RateInjection, EndsWhateverTheFullScale) {
  const Recording run = kDrifting.recording();
  const auto blocks = replay(bias_only, run, bias_only(run), std::nan(""), 0);
  ASSERT_TRUE(blocks);
  EXPECT_TRUE(blocks->empty());  // no rate is within a full scale of NaN
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

TEST(RateInjection, CatchesWhatForgetsAConstantAndWhatComesLate) {
  // Zeroes itself once the rate was still for a minute.
  const auto zeroes_itself = [](const Recording& run) {
    auto answer = column_values(run, "rate");
    double held = std::nan("");
    double since = 0.0;
    for (std::size_t k = 0; k < answer.size(); ++k) {
      const double here = answer[k];
      if (!(std::abs(here - held) < 0.01)) {
        held = here;
        since = run.time[k];
      }
      if (run.time[k] - since > 60.0) answer[k] = 0.0;
    }
    return answer;
  };
  const auto late = [](const Recording& run) {
    auto answer = column_values(run, "rate");
    for (std::size_t k = answer.size() - 1; k >= 44; --k)
      answer[k] = answer[k - 4];  // by 2 s
    return answer;
  };
  RecordedRun still = kDrifting;
  still.bias = [](double t) { return 1e-3 * std::sin(t); };
  const Recording run = still.recording();
  EXPECT_LT(*injected_scale_factor(zeroes_itself, run), 0.5);
  EXPECT_LT(*injected_scale_factor(late, run), 0.5);
}

TEST(RateInjection, MovesOutputAndRateByTheSameRate) {
  const Recording run = kDrifting.recording();
  std::vector<double> injected(run.time.size(), 2.0);
  injected[3000] = -7.0;
  const auto moved = with_injected_rate(run, injected);
  ASSERT_TRUE(moved);
  const auto& before = column_values(run, "rate");
  const auto& rate = column_values(*moved, "rate");
  const auto& output = column_values(*moved, "output");
  EXPECT_TRUE(std::isnan(rate[0]));
  EXPECT_NEAR(rate[100] - before[100], 2.0, 1e-14);
  EXPECT_NEAR(rate[3000] - before[3000], -7.0, 1e-14);
  for (std::size_t k = 100; k < rate.size(); k += 100) {
    EXPECT_NEAR(output[k], 2.5 + 0.0125 * rate[k], 1e-12);
  }
  EXPECT_EQ(column_values(*moved, "temperature")[100],
            column_values(run, "temperature")[100]);
  ASSERT_NE(find_column(run, "true_rate"), nullptr);
  EXPECT_EQ(find_column(*moved, "true_rate"), nullptr);
}

TEST(RateInjection, HoldsRatesOfEachSizeAndSignUpToTheLargest) {
  constexpr std::uint64_t kHidden = 0x123456789abcdef;
  EXPECT_EQ(held_rate(0, 150.0, kHidden), 150.0);
  // Rates by sign and tenth of the four decades: as many of each, within one.
  std::map<std::pair<bool, int>, int> count;
  for (std::size_t hold = 0; hold < 800; ++hold) {
    const double rate = held_rate(hold, 150.0, kHidden);
    ASSERT_LE(std::abs(rate), 150.0);
    ASSERT_GT(std::abs(rate), 0.015);
    ++count[{
        rate > 0.0,
        static_cast<int>(-10.0 * std::log10(std::abs(rate) / 150.0) / 4.0)}];
  }
  ASSERT_EQ(count.size(), 20U);
  for (const auto& [kind, holds] : count) EXPECT_NEAR(holds, 40, 3);
}

// Else a plug-in takes the rates off, and eats what is left in every recording.
TEST(RateInjection, HoldsRatesThatOnlyTheUnalteredRecordingTells) {
  const auto rates_of = [](const Recording& run) {
    std::vector<double> rates;
    for (std::size_t hold = 1; hold < 400; ++hold)
      rates.push_back(
          std::log10(std::abs(held_rate(hold, 150.0, hidden_number(run)))));
    return rates;
  };
  Recording other = kDrifting.recording();
  const std::vector<double> one = rates_of(other);
  EXPECT_EQ(one, rates_of(other));
  auto& rate = std::ranges::find(other.columns, "rate", &Column::name)->values;
  rate.back() = std::nextafter(rate.back(), 1e3);
  const std::vector<double> two = rates_of(other);
  // What is left when they are shifted as well as can be.
  std::vector<double> turned;
  for (std::size_t k = 0; k < one.size(); ++k)
    turned.push_back(std::remainder(one[k] - two[k], 4.0));
  const auto [low, high] = std::ranges::minmax(turned);
  EXPECT_GT(high - low, 0.06);
  double apart = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k)
    apart = std::max(apart, std::abs(one[k] - two[k]));
  EXPECT_GT(apart, 0.1);
}

TEST(RateInjection, ReplaysEverySettledSecondWithPowerWithinFullScale) {
  RecordedRun turning = kDrifting;
  turning.true_rate = [](double t) { return t < 1800.0 ? 0.0 : 100.0; };
  const Recording run = turning.recording();
  const auto blocks = replay(bias_only, run, bias_only(run), 150.0);
  ASSERT_TRUE(blocks);
  double largest = 0.0, together = 0.0, last = 0.0;
  for (const ReplayedBlock& block : *blocks) {
    EXPECT_GE(block.time, 20.0);
    largest = std::max(largest, std::abs(block.rate));
    const double total = block.rate + (block.time < 1800.0 ? 0.0 : 100.0);
    together = std::max(together, std::abs(total));
    last = std::max(last, block.time);
  }
  EXPECT_EQ(largest, 150.0);
  EXPECT_LE(together, 1.01 * 150.0);
  EXPECT_NEAR(last, 3600.0, 1.5);
  // Three settled seconds of each four and all but one of each long hold.
  EXPECT_GT(blocks->size(), 1780U + 2680U);
}

TEST(RateInjection, FullScaleIsTheDevicesWithItsOverrides) {
  Recording run;
  EXPECT_FALSE(stated_full_scale(run));
  run.device_text = "[readout]\nfull_scale_deg_per_s = 300\n";
  EXPECT_EQ(stated_full_scale(run), 300.0);
  run.overrides_text = "noise.enabled=false\nreadout.full_scale_deg_per_s=75\n";
  EXPECT_EQ(stated_full_scale(run), 75.0);
  run.device_text = "a map of another program {";
  EXPECT_FALSE(stated_full_scale(run));
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
  EXPECT_THROW(
      with_injected_rate(run, std::vector<double>(run.time.size(), 1.0)),
      std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::rate_injection_test
