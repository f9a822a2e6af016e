// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "compensation/scoring/validation.h"
#include "tests/compensation/recorded_run.h"

namespace beamgyro::internal::cheating_compensators_test {
namespace {

constexpr double kOffset = 1.5;  // [deg/s], most of the drift there is

// Two soaks at rest, ten minutes of ramp between them, the power-on at 0 s.
RecordedRun two_soaks() {
  RecordedRun run{.duration = 7200.0, .step = 1.0};
  run.temperature = [](double t) {
    return 20.0 * std::clamp((t - 3600.0) / 600.0, 0.0, 1.0);
  };
  run.bias = [T = run.temperature](double t) {
    return kOffset + 0.02 * (T(t) - 10.0);
  };
  return run;
}

BiasModel model_of(std::size_t inputs, decltype(BiasModel::function) function) {
  return {std::vector<Scale>(inputs), {}, std::move(function)};
}

Compensator compensator_of(const std::vector<std::string>& inputs,
                           decltype(BiasModel::function) function) {
  Compensator c;
  c.bias = model_of(inputs.size(), std::move(function));
  c.baseline = model_of(1, Polynomial{{0.0}});
  c.temperature_range = {-40.0, 60.0};
  for (const std::string& input : inputs)
    c.inputs.push_back(parse_input(input));
  return c;
}

// The sound offset, and `eaten` of every rate about it.
Compensator eats(double (*eaten)(double), double step) {
  const auto knots = static_cast<Eigen::Index>(400.0 / step) + 1;
  LookupTable table{Eigen::ArrayXd::LinSpaced(knots, -200.0, 200.0),
                    Eigen::ArrayXd(knots)};
  for (Eigen::Index k = 0; k < knots; ++k)
    table.values(k) = kOffset + eaten(table.temperatures(k) - kOffset);
  return compensator_of({"rate"}, table);
}

// The sound offset but where `input` is within `half` of `at`: there `share`
// of the rate is eaten as well.
Compensator eats_within(const std::string& input, double at, double half,
                        double share) {
  TakagiSugeno rules;
  rules.centres = Eigen::Array3d(at - 2.0 * half, at, at + 2.0 * half);
  rules.width = 0.1 * half;
  rules.consequents.resize(3, 3);
  rules.consequents << kOffset, 0.0, 0.0,  //
      (1.0 - share) * kOffset, 0.0, share, kOffset, 0.0, 0.0;
  return compensator_of({input, "rate"}, rules);
}

Validation at_rest(const Compensator& compensator) {
  const Recording rest = two_soaks().recording();
  return validate(compensator, "cheat", {{"rest", &rest}});
}

bool residual_passes(const Validation& found) {
  return found.checks.back().name == "residual" && found.checks.back().passed;
}

TEST(CheatingCompensators, AScaleFactorThatDividesEverythingAway) {
  Compensator cheat = compensator_of({"temperature"}, ConstantBias{kOffset});
  cheat.scale_factor =
      LookupTable{Eigen::ArrayXd::Zero(1), Eigen::ArrayXd::Constant(1, 1e9)};
  const Validation found = at_rest(cheat);
  EXPECT_LT(found.overall.residual.rms, 1e-6);
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
}

TEST(CheatingCompensators, AStaircaseThatEatsLargeRates) {
  const Validation found = at_rest(eats(
      [](double rate) {
        const double beyond = std::max(std::abs(rate) - 15.0, 0.0);
        return std::copysign(0.92 * beyond, rate);
      },
      5.0));
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
}

TEST(CheatingCompensators, AWindowOfATenthOfAKelvin) {
  const Validation found = at_rest(eats_within("temperature", 8.0, 0.05, 1.0));
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
}

TEST(CheatingCompensators, ATemperatureThatNoRunShows) {
  const Validation found = at_rest(eats_within("temperature", 40.0, 0.1, 1.0));
  EXPECT_NEAR(found.overall.replayed->worst.worse()->retained, 1.0, 1e-9);
  EXPECT_NEAR(found.overall.replayed->over_temperature.worse()->temperature,
              40.0, 0.1);
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
}

TEST(CheatingCompensators, AWindowOfTimeSincePowerOn) {
  // Five seconds after twenty minutes with power.
  const double centre = std::exp(-1.2), half = 2.5e-3 * centre;
  const Validation found =
      at_rest(eats_within("since_power_on(1000)", centre, half, 1.0));
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
}

TEST(CheatingCompensators, AWindowThatEatsALittle) {
  const Validation found = at_rest(eats_within("temperature", 8.0, 0.5, 0.02));
  EXPECT_EQ(verdict_text(found.verdict), "bends the scale factor");
}

TEST(CheatingCompensators, ADeadbandAboutTheOffset) {
  const Validation found = at_rest(
      eats([](double rate) { return std::clamp(rate, -0.3, 0.3); }, 0.1));
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "cancels the rate");
}

TEST(CheatingCompensators, ALimiterBelowFullScale) {
  const Validation found = at_rest(
      eats([](double rate) { return rate - std::clamp(rate, -120.0, 120.0); },
           10.0));
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "bends the scale factor");
}

TEST(CheatingCompensators, OneDirectionOfLargeRates) {
  const Validation found = at_rest(
      eats([](double rate) { return std::min(rate + 50.0, 0.0) * 0.1; }, 10.0));
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "bends the scale factor");
}

TEST(CheatingCompensators, ARippleThatIsZeroAtEveryRateOfATable) {
  const auto ripple = [](double rate) {
    return 0.1 * std::sin(2.0 * std::numbers::pi * rate / 24.0);
  };
  const Validation found = at_rest(eats(ripple, 0.5));
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "bends the scale factor");
}

// A network on what a replayed rate does not move, beside a sound offset.
Compensator on_what_a_replay_leaves() {
  return compensator_of({"quadrature", "drive_voltage", "drive_frequency"},
                        Polynomial{{kOffset, 1.0}, {0.1, 0.0}});
}

// Quadrature that leaks a hundredth of the rate.
Recording with_drive_signals(const RecordedRun& run) {
  Recording recording = run.recording();
  std::vector<double> quadrature = column_values(recording, "true_rate");
  for (double& value : quadrature) value *= 0.01;
  const std::vector<double> steady(quadrature.size(), 0.0);
  recording.columns.push_back(
      {"quadrature", "degree/s", "", Role::kMeasured, quadrature});
  recording.columns.push_back(
      {"drive_voltage", "V", "", Role::kMeasured, steady});
  recording.columns.push_back(
      {"drive_frequency", "Hz", "", Role::kMeasured, steady});
  return recording;
}

TEST(CheatingCompensators, WhatAReplayCannotMoveIsNotTested) {
  const Recording rest = with_drive_signals(two_soaks());
  const Validation found =
      validate(on_what_a_replay_leaves(), "network", {{"rest", &rest}});
  EXPECT_TRUE(residual_passes(found));
  EXPECT_EQ(verdict_text(found.verdict), "scale factor not tested");
  EXPECT_FALSE(found.passed());
}

TEST(CheatingCompensators, RecordedRatesMoveWhatAReplayCannot) {
  RecordedRun turning = two_soaks();
  turning.true_rate = rate_table(120.0, 11, 60.0);
  const Recording rates = with_drive_signals(turning);
  const Validation found =
      validate(on_what_a_replay_leaves(), "network", {{"rates", &rates}});
  // It takes the hundredth of the rate that leaks for drift.
  EXPECT_NEAR(found.overall.every_rate->retained, 0.99, 1e-6);
  EXPECT_EQ(verdict_text(found.verdict), "bends the scale factor");
}

}  // namespace
}  // namespace beamgyro::internal::cheating_compensators_test
