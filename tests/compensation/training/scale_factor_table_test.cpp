// SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compensation/compensator/compensator.h"
#include "compensation/scoring/scale_factor.h"
#include "compensation/training/train.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::scale_factor_table_test {
namespace {

constexpr double kSoak = 1320.0;  // [s], two rounds of 11 rates of 60 s

LookupTable table_of(const std::vector<Recording>& recordings, double width) {
  std::vector<TrainingRun> runs;
  for (const Recording& recording : recordings)
    runs.push_back({"run.h5", "", recording});
  return fit_scale_factor(source_of(runs), width);
}

double true_scale(double T) { return 1.0 + 1e-4 * (T - 25.0); }

// A rate table at -35, -25, ... 45 degC with a bias that drifts within a soak
// by more than the change of the scale factor by 10 K does at 100 deg/s.
RecordedRun rate_tables(double offset = 0.0) {
  RecordedRun run{.duration = 9.0 * kSoak, .step = 1.0};
  run.temperature = [=](double t) {
    return -35.0 + 10.0 * std::floor(t / kSoak) + offset;
  };
  run.true_rate = rate_table(100.0, 11, 60.0);
  run.scale_factor = [T = run.temperature](double t) {
    return true_scale(T(t));
  };
  run.bias = [](double t) {
    return 0.4 * std::sin(2.0 * std::numbers::pi * t / 2400.0) + 2e-4 * t;
  };
  return run;
}

TEST(ScaleFactorTable, RecoversTheScaleFactorInSpiteOfDrift) {
  const Recording recording = rate_tables().recording();
  const LookupTable table = table_of({recording}, 10.0);
  ASSERT_EQ(table.temperatures.size(), 9);
  for (Eigen::Index k = 0; k < 9; ++k) {
    EXPECT_NEAR(table.temperatures(k), -35.0 + 10.0 * double(k), 1e-9);
    EXPECT_NEAR(table.values(k), true_scale(table.temperatures(k)), 3e-5) << k;
  }
  EXPECT_NEAR(table.at(20.0), true_scale(20.0), 3e-5);
  EXPECT_EQ(table.at(85.0), table.values(8));
}

TEST(ScaleFactorTable, WithoutDriftItIsExactAndBinsAreJoined) {
  RecordedRun run = rate_tables();
  run.bias = [](double) { return -3.0; };
  const Recording one = run.recording();
  const LookupTable table = table_of({one}, 20.0);
  // [-40, -20), [-20, 0), ... two soaks each, the last one.
  ASSERT_EQ(table.temperatures.size(), 5);
  for (Eigen::Index k = 0; k < 5; ++k) {
    EXPECT_NEAR(table.temperatures(k), k < 4 ? -30.0 + 20.0 * double(k) : 45.0,
                0.01);
    EXPECT_NEAR(table.values(k), true_scale(table.temperatures(k)), 1e-9);
  }
}

// The output shows a step one sample after the true rate does.
TEST(ScaleFactorTable, LagBehindTheStepsOfTheRateIsNoScaleFactor) {
  RecordedRun run = rate_tables();
  run.bias = [table = run.true_rate](double t) {
    return table(std::max(t - 1.0, 0.0)) - table(t);
  };
  const Recording recording = run.recording();
  const LookupTable table = table_of({recording}, 10.0);
  for (Eigen::Index k = 0; k < table.values.size(); ++k)
    EXPECT_NEAR(table.values(k), true_scale(table.temperatures(k)), 1e-6) << k;
}

TEST(ScaleFactorTable, ARateThatIsNeverHeldServesToo) {
  RecordedRun run = rate_tables();
  run.true_rate = [](double t) { return 90.0 * std::sin(0.7 * t); };
  const Recording recording = run.recording();
  const LookupTable table = table_of({recording}, 10.0);
  ASSERT_EQ(table.values.size(), 9);
  for (Eigen::Index k = 0; k < 9; ++k)
    EXPECT_NEAR(table.values(k), true_scale(table.temperatures(k)), 1e-4) << k;
}

TEST(ScaleFactorTable, RecordingsAtRestAddNothing) {
  RecordedRun still = rate_tables();
  still.true_rate = [](double) { return 4.0; };
  const Recording rest = still.recording(), turning = rate_tables().recording();
  EXPECT_TRUE(holds(rejection([&] { table_of({rest}, 10.0); }),
                    "varies by 5 deg/s at a steady temperature; none of the "
                    "1 does"));
  EXPECT_TRUE((table_of({rest, turning}, 10.0).values ==
               table_of({turning}, 10.0).values)
                  .all());
}

std::vector<TrainingRun> run(const std::string& name,
                             const Recording& recording) {
  return {{name + ".h5", "sha of " + name, recording}};
}

TEST(ScaleFactorTable, ATrainedCompensatorCorrectsIt) {
  const auto without_drift = [](double offset) {
    RecordedRun run = rate_tables(offset);
    run.bias = [T = run.temperature](double t) { return 0.7 + 0.01 * T(t); };
    return run.recording();
  };
  const Recording training = without_drift(0.0), other = without_drift(3.0);
  ModelSpec spec{.inputs = {parse_input("temperature")},
                 .kind = PolynomialSpec{3}};
  const auto slope = [&](const ModelSpec& model) {
    const FittedCompensator c =
        train(model, run("training", training), {}, 1).compensator;
    return scale_factor(slope_sums(other, compensated_rate(c, other)))->slope;
  };
  EXPECT_GT(std::abs(slope(spec) - 1.0), 8e-4);
  spec.scale_factor_bin_K = 10.0;
  EXPECT_NEAR(slope(spec), 1.0, 1e-4);
}

TEST(ScaleFactorTable, TheBiasIsWhatTheCorrectedRateLeaves) {
  RecordedRun made = rate_tables();
  made.bias = [](double) { return 0.7; };
  ModelSpec spec{.inputs = {parse_input("temperature")},
                 .kind = ConstantSpec{},
                 .scale_factor_bin_K = 10.0};
  const Recording recording = made.recording();
  const FittedCompensator c =
      train(spec, run("training", recording), {}, 1).compensator;
  EXPECT_NEAR(std::get<ConstantBias>(c.bias.function).value, 0.7, 1e-7);
  const std::vector<double> rate = compensated_rate(c, recording);
  for (std::size_t k = 0; k < rate.size(); ++k)
    ASSERT_NEAR(rate[k], made.true_rate(recording.time[k]), 1e-6);
}

}  // namespace
}  // namespace beamgyro::internal::scale_factor_table_test
