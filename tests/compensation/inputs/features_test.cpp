// SPDX-License-Identifier: MIT
#include "compensation/inputs/features.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::features_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<Input> inputs(const std::vector<std::string>& names) {
  std::vector<Input> result;
  for (const std::string& name : names) result.push_back(parse_input(name));
  return result;
}

// Sampling times that repeat no interval.
std::vector<double> irregular_times(int count) {
  std::vector<double> times{0.0};
  for (int k = 1; k < count; ++k)
    times.push_back(times.back() + 1.0 + 0.9 * std::sin(1.7 * k));
  return times;
}

TEST(LowPass, FollowsARampByTheClosedFormHoweverIrregularTheSamples) {
  const double tau = 7.0, slope = 0.3;  // [s, K/s]
  LowPass low_pass(tau);
  for (const double t : irregular_times(60)) {
    const double exact = slope * (t - tau * (1.0 - std::exp(-t / tau)));
    EXPECT_NEAR(low_pass.step(t, slope * t), exact, 1e-12) << "t = " << t;
  }
}

TEST(LowPass, ForgetsAStepExponentially) {
  const double tau = 100.0;
  LowPass low_pass(tau);
  low_pass.step(0.0, 0.0);
  const double start = low_pass.step(1e-9, 1.0);
  EXPECT_NEAR(start, 0.0, 1e-9);
  for (const double t : {0.5, 3.0, 80.0, 1000.0})
    EXPECT_NEAR(low_pass.step(t, 1.0), 1.0 - std::exp(-t / tau), 1e-9);
}

TEST(LowPass, ConstantInputPassesExactly) {
  LowPass low_pass(400.0);
  for (const double t : irregular_times(20))
    EXPECT_EQ(low_pass.step(t, 23.7), 23.7);
}

TEST(LowPass, CommonTimesAgreeWhetherSampledFinelyOrCoarsely) {
  LowPass fine(13.0), coarse(13.0);
  for (int k = 0; k <= 400; ++k) {
    const double t = 0.1 * k;
    const double y = fine.step(t, 2.0 * t);
    if (k % 50 == 0) {
      EXPECT_NEAR(coarse.step(t, 2.0 * t), y, 1e-11);
    }
  }
}

TEST(Features, TimeSincePowerOnDecaysFromOneAtEachPowerOn) {
  RecordedRun run{.duration = 300.0, .step = 1.0};
  run.powered = [](double t) {
    return t >= 50.0 && !(t >= 150.0 && t < 170.0);
  };
  const Eigen::ArrayXXd x =
      features_of(inputs({"since_power_on(30)"}), run.recording());
  EXPECT_TRUE(std::isnan(x(49, 0)));
  EXPECT_EQ(x(50, 0), 1.0);
  EXPECT_NEAR(x(140, 0), std::exp(-90.0 / 30.0), 1e-15);
  EXPECT_TRUE(std::isnan(x(160, 0)));
  EXPECT_EQ(x(170, 0), 1.0);
  EXPECT_NEAR(x(200, 0), std::exp(-1.0), 1e-15);
}

TEST(Features, FiltersStartAnewAtEachPowerOn) {
  RecordedRun run{.duration = 300.0, .step = 1.0};
  run.temperature = [](double t) { return 20.0 + 0.1 * t; };
  run.powered = [](double t) { return t < 150.0 || t >= 170.0; };
  const Eigen::ArrayXXd x = features_of(
      inputs({"temperature", "temperature_lowpass(100)"}), run.recording());
  EXPECT_EQ(x(0, 1), x(0, 0));
  EXPECT_LT(x(149, 1), x(149, 0) - 1.0);
  EXPECT_EQ(x(170, 1), x(170, 0));
  EXPECT_NEAR(x(270, 0) - x(270, 1), 0.1 * 100.0 * (1.0 - std::exp(-1.0)),
              1e-9);
}

TEST(Features, FutureSamplesDoNotChangeThePast) {
  RecordedRun run{.duration = 200.0, .step = 1.0};
  run.temperature = [](double t) { return 20.0 + 5.0 * std::sin(0.05 * t); };
  const std::vector<Input> names =
      inputs({"temperature_lowpass(40)", "since_power_on(60)", "output"});
  const Eigen::ArrayXXd before = features_of(names, run.recording());
  Recording changed = run.recording();
  for (std::size_t k = 120; k < 200; ++k)
    for (Column& column : changed.columns) column.values[k] += 10.0;
  const Eigen::ArrayXXd after = features_of(names, changed);
  EXPECT_TRUE((after.topRows(120) == before.topRows(120)).all());
  EXPECT_TRUE(
      (after.bottomRows(79).col(0) != before.bottomRows(79).col(0)).all());
}

TEST(Features, SteppingOneByOneGivesTheBitsOfTheWholeRecording) {
  RecordedRun run{.duration = 200.0, .step = 0.5};
  run.temperature = [](double t) { return 20.0 + 5.0 * std::sin(0.05 * t); };
  const std::vector<Input> names =
      inputs({"temperature_lowpass(40)", "since_power_on(60)"});
  const Recording recording = run.recording();
  const Eigen::ArrayXXd whole = features_of(names, recording);
  FeatureStream stream(names);
  for (std::size_t k = 0; k < recording.time.size(); ++k) {
    const double T = column_values(recording, "temperature")[k];
    double x[2];
    ASSERT_TRUE(stream.step(recording.time[k], 0, std::vector{T, 0.0}, x));
    EXPECT_EQ(x[0], whole(static_cast<Eigen::Index>(k), 0));
    EXPECT_EQ(x[1], whole(static_cast<Eigen::Index>(k), 1));
  }
}

TEST(Features, TemperatureIsClampedBeforeItIsFiltered) {
  RecordedRun run{.duration = 100.0, .step = 1.0};
  run.temperature = [](double t) { return t; };
  const Eigen::ArrayXXd x =
      features_of(inputs({"temperature", "temperature_lowpass(5)"}),
                  run.recording(), {.lowest = 10.0, .highest = 60.0});
  EXPECT_EQ(x(3, 0), 10.0);
  EXPECT_EQ(x(3, 1), 10.0);
  EXPECT_EQ(x(90, 0), 60.0);
  EXPECT_NEAR(x(99, 1), 60.0, 0.01);
  EXPECT_LE(x.col(1).maxCoeff(), 60.0);
}

TEST(Features, MissingColumnIsNamedTogetherWithThoseThereAre) {
  const Recording recording = RecordedRun{}.recording();
  const std::string message =
      rejection([&] { features_of(inputs({"drive_frequency"}), recording); });
  EXPECT_TRUE(holds(message, "drive_frequency"));
  EXPECT_TRUE(holds(message, "output, rate, temperature"));
  EXPECT_FALSE(holds(message, "true_rate"));
}

TEST(Features, TruthUnderTheNameOfAnInputIsRejected) {
  Recording recording = RecordedRun{}.recording();
  recording.columns[2].role = Role::kTruth;
  EXPECT_THROW(features_of(inputs({"temperature"}), recording),
               std::invalid_argument);
}

// An infinite temperature would count as the end of the range it is clamped to.
TEST(Features, NoFiniteNumberAtAPoweredSampleIsAnErrorNotAGap) {
  for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL}) {
    Recording recording = RecordedRun{}.recording();
    recording.columns[2].values[7] = bad;
    const std::string message = rejection([&] {
      features_of(inputs({"temperature_lowpass(9)"}), recording,
                  {.lowest = -40.0, .highest = 50.0});
    });
    EXPECT_TRUE(
        holds(message, fmt::format("temperature is {} at t = 3.5 s", bad)));
  }
}

TEST(Features, TemperatureRateOfARampIsItsSlopeOnceTheFilterHasSettled) {
  const double tau = 60.0, slope = 0.02;  // [s, K/s]
  FeatureStream stream(inputs({"temperature_rate(60)"}));
  double rate[1];
  for (const double t : irregular_times(400)) {
    ASSERT_TRUE(stream.step(t, 0, std::vector{-30.0 + slope * t}, rate));
    // (x - y) / tau with tau y' = x - y
    ASSERT_NEAR(rate[0], slope * (1.0 - std::exp(-t / tau)), 1e-14) << t;
  }
  EXPECT_NEAR(rate[0], slope, 0.01 * slope);
}

TEST(Features, TemperatureRateStartsAtZeroAtEachPowerOn) {
  RecordedRun run{.duration = 300.0, .step = 1.0};
  run.temperature = [](double t) { return 20.0 + 0.1 * t; };
  run.powered = [](double t) { return t < 150.0 || t >= 170.0; };
  const Eigen::ArrayXXd x =
      features_of(inputs({"temperature_rate(40)"}), run.recording());
  EXPECT_EQ(x(0, 0), 0.0);
  EXPECT_NEAR(x(149, 0), 0.1 * (1.0 - std::exp(-149.0 / 40.0)), 1e-13);
  EXPECT_TRUE(std::isnan(x(160, 0)));
  EXPECT_EQ(x(170, 0), 0.0);
  EXPECT_NEAR(x(210, 0), 0.1 * (1.0 - std::exp(-1.0)), 1e-13);
}

TEST(Features, TemperatureRateForgetsAStepAndSeesNoConstant) {
  FeatureStream stream(inputs({"temperature_rate(10)"}));
  double rate[1];
  for (const double t : {0.0, 3.0, 4.0, 50.0}) {
    stream.step(t, 0, std::vector{23.7}, rate);
    EXPECT_EQ(rate[0], 0.0);
  }
  stream.step(50.0 + 1e-9, 0, std::vector{24.7}, rate);
  EXPECT_NEAR(rate[0], 0.1, 1e-9);  // 1 K / 10 s
  stream.step(70.0, 0, std::vector{24.7}, rate);
  EXPECT_NEAR(rate[0], 0.1 * std::exp(-2.0), 1e-9);
}

TEST(Features, TemperatureRateIsZeroWhereTheTemperatureIsClamped) {
  RecordedRun run{.duration = 600.0, .step = 1.0};
  run.temperature = [](double t) { return 20.0 + 0.1 * t; };
  const Eigen::ArrayXXd x =
      features_of(inputs({"temperature_rate(20)"}), run.recording(),
                  {.lowest = 0.0, .highest = 30.0});
  EXPECT_NEAR(x(99, 0), 0.1, 1e-3);
  EXPECT_NEAR(x(599, 0), 0.0, 1e-10);
}

// From the first temperature up to T, back down and up again: p = T - r after
// a rise, T + r after a fall, and what it was in between.
TEST(Features, PlayFollowsTheTemperatureOnlyWhenPushed) {
  FeatureStream stream(inputs({"temperature_play(2)"}));
  double p[1];
  double time = 0.0;
  for (const auto& [T, expected] : {std::pair{20.0, 20.0},
                                    {21.0, 20.0},
                                    {25.0, 23.0},
                                    {22.0, 23.0},
                                    {21.0, 23.0},
                                    {18.0, 20.0},
                                    {21.5, 20.0},
                                    {23.0, 21.0}}) {
    ASSERT_TRUE(stream.step(time += 1.0, 0, std::vector{T}, p));
    EXPECT_DOUBLE_EQ(p[0], expected) << T;
  }
}

// A cycle between 10 and 30 degC encloses 2 r (T_2 - T_1 - 2 r) in the (T, p)
// plane, however fast it is run through.
TEST(Features, PlayEnclosesTheSameAreaAtAnyRate) {
  for (const double slope : {0.01, 0.5}) {  // [K/s]
    FeatureStream stream(inputs({"temperature_play(3)"}));
    const int way = static_cast<int>(std::lround(20.0 / slope));
    double area = 0.0, before = 10.0, p[1];
    for (int k = 0; k <= 4 * way; ++k) {
      const double T = 30.0 - slope * std::abs(k % (2 * way) - way);
      stream.step(k, 0, std::vector{T}, p);
      if (k > 2 * way)
        area += 0.5 * (p[0] + before) * slope *
                ((k - 1) % (2 * way) < way ? -1.0 : 1.0);
      before = p[0];
    }
    EXPECT_NEAR(area, 2.0 * 3.0 * (20.0 - 2.0 * 3.0), 1e-6);
  }
}

TEST(Features, PlayStartsAtTheTemperatureOfEachPowerOn) {
  RecordedRun run{.duration = 300.0, .step = 1.0};
  run.temperature = [](double t) { return 20.0 + 0.1 * t; };
  run.powered = [](double t) { return t < 150.0 || t >= 170.0; };
  const Eigen::ArrayXXd x =
      features_of(inputs({"temperature_play(1.5)"}), run.recording(),
                  {.lowest = 0.0, .highest = 45.0});
  EXPECT_EQ(x(0, 0), 20.0);
  EXPECT_DOUBLE_EQ(x(149, 0), 34.9 - 1.5);
  EXPECT_TRUE(std::isnan(x(160, 0)));
  EXPECT_EQ(x(170, 0), 37.0);
  EXPECT_EQ(x(180, 0), 37.0);
  EXPECT_DOUBLE_EQ(x(299, 0), 45.0 - 1.5);  // of the clamped temperature
}

}  // namespace
}  // namespace beamgyro::internal::features_test
