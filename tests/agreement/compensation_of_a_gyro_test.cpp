// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "compensation/training/train.h"
#include "random/random_stream.h"
#include "sim/dynamics/gyro.h"
#include "sim/scenario/simulation.h"
#include "tests/compensation/injected_scale_factor.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/scenario/scenario_text.h"

namespace beamgyro::internal::compensation_of_a_gyro_test {
namespace {

ModelSpec shipped_model(const std::string& name) {
  return read_model(std::string(BEAMGYRO_SCENARIOS) + "/models/" + name +
                    ".toml");
}

// The zero-rate output over temperature as a recording at rest with one sample
// a minute; noise in deg/s.
Recording bias_curve(const TrimmedGyro& gyro, double first, double last,
                     double step, double noise, std::uint32_t run) {
  RandomStream random(11, 0, run, kWhiteNoiseStream);
  Recording recording;
  Column rate{"rate", "degree/s", "", Role::kMeasured, {}};
  Column temperature{"temperature", "degC", "", Role::kMeasured, {}};
  for (double celsius = first; celsius <= last + 1e-9; celsius += step) {
    const double T = celsius + kZeroCelsius;
    const double bias = electronics_at(gyro, T)
                            .output(beam_signal(gyro, T, {}).demodulated)
                            .rate /
                        kDegree;
    recording.time.push_back(60 * static_cast<double>(recording.time.size()));
    temperature.values.push_back(celsius);
    rate.values.push_back(bias + noise * random.normal());
  }
  recording.status.assign(recording.time.size(), 0);
  Column truth{"true_rate", "degree/s", "", Role::kTruth,
               std::vector<double>(recording.time.size(), 0)};
  recording.columns = {rate, temperature, truth};
  return recording;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(Verification, V43CubicAgainstNetworkAndSplineOnTheBiasCurve) {
  constexpr double kLabelNoise = 0.005;  // [deg/s]
  const TrimmedGyro gyro = make_gyro(verification_device());
  const std::vector<TrainingRun> grid = {
      {"grid", "a", bias_curve(gyro, -40, 50, 2.5, kLabelNoise, 0)}};
  const std::vector<TrainingRun> held_out = {
      {"between", "b", bias_curve(gyro, -38.75, 48.75, 2.5, kLabelNoise, 1)}};
  const Recording dense = bias_curve(gyro, -40, 50, 0.1, 0, 2);
  const auto residual = [&](const std::string& model) {
    const TrainResult result = train(shipped_model(model), grid, held_out, 1);
    return rms(compensated_rate(result.compensator, dense));
  };
  EXPECT_NEAR(residual("cubic") / 0.39, 1, 0.1);
  EXPECT_LT(residual("bp"), 0.006);
  EXPECT_LT(residual("spline"), 0.006);
}

Recording rest_sweep(const std::string& extra = "") {
  return simulated(
      scenario_from(extra,
                    "[ambient.soaks]\ntemperatures_degC = [-40, 50]\n"
                    "hold_s = 1800\nramp_K_per_min = 1\n[chamber]\n"
                    "stirred = true\n",
                    "9000", "1"),
      nominal_device());
}

TEST(Verification, V44ANetworkOnTheOutputCancelsTheRate) {
  const std::vector<TrainingRun> runs = {{"sweep", "a", rest_sweep()}};
  const std::vector<TrainingRun> held_out = {
      {"quiet", "b", rest_sweep("[noise]\nenabled = false\n")}};
  const auto retained = [&](const std::string& model) {
    const TrainResult result = train(shipped_model(model), runs, held_out, 1);
    return injected_scale_factor(
        [&](const Recording& run) {
          return compensated_rate(result.compensator, run);
        },
        runs.front().recording);
  };
  EXPECT_LT(std::abs(retained("output_and_temperature").value()), 0.05);
  EXPECT_NEAR(retained("recommended").value(), 1, 1e-12);
  EXPECT_NEAR(retained("cubic").value(), 1, 1e-12);
}

}  // namespace
}  // namespace beamgyro::internal::compensation_of_a_gyro_test
