// SPDX-License-Identifier: MIT
#include "tests/sim/stepper/replay.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "dataset/recording/signals.h"
#include "tests/sim/scenario/scenario_text.h"
#include "tests/sim/stepper/shipped_device.h"

namespace beamgyro::internal::replay_test {
namespace {

struct Case {
  const char* name;
  const char* device;
  const char* ambient;
  const char* extra;
  const char* duration = "100";
};

constexpr const char* kRamp = "[ambient]\npoints = [[0, -20], [600, 40]]\n";
constexpr const char* kRoom = "[ambient]\nconstant_degC = 25\n";
constexpr const char* kZigzag =
    "[ambient]\npoints = [[0, 10], [150.03, 30], [300, 5], [450.071, 35], "
    "[600, 20]]\n";
constexpr const char* kStirred =
    "[chamber]\nstirred = true\n[ambient]\npoints = [[0, 0], [300, 50]]\n";
constexpr const char* kSteep =
    "[ambient]\npoints = [[0, 0], [100.003, 0], [100.004, 30], [300, 30]]\n";
constexpr const char* kSteps =
    "[rate]\nsteps = [[0, 0], [50.05, 100], [70, -60]]\n";
constexpr const char* kPoints =
    "[rate]\npoints = [[0, 0], [20.013, 80], [40, -120], [60.5, 10]]\n";
constexpr const char* kCross =
    "[cross_rate.x]\nsteps = [[0, 0], [30.003, 40]]\n"
    "[cross_rate.y]\npoints = [[0, -20], [55.5, 30]]\n";
constexpr const char* kGravity =
    "[acceleration.z]\nconstant_g = 1\n"
    "[acceleration.x]\npoints = [[0, 0], [50, 2], [90, -2]]\n";
constexpr const char* kCycles =
    "[power]\non_s = [10, 60.02, 80]\noff_s = [40.017, 70]\n";
constexpr const char* kLongCycles =
    "[power]\non_s = [10, 400]\noff_s = [300.017]\n";
constexpr const char* kAge = "[age]\nhours = 2000\n";
constexpr const char* kHistory =
    "[history]\npoints = [[-7200, 60], [-3600, -20], [-60, 25], [0, 25]]\n";

const std::vector<Case> kWithoutMemory = {
    {"Rest", "nominal", kRoom, ""},
    {"WarmUp", "nominal", kRoom, "", "900"},
    {"Ramp", "nominal", kRamp, "", "600"},
    {"Zigzag", "nominal", kZigzag, kPoints, "600"},
    {"Steps", "nominal", kRoom, kSteps},
    {"Points", "nominal", kRamp, kPoints},
    {"Cross", "nominal", kRoom, kCross},
    {"Gravity", "nominal", kRoom, kGravity},
    {"PowerCycles", "nominal", kRoom, kCycles},
    {"Age", "nominal", kRoom, kAge},
    {"Oven", "oven", kRamp, kLongCycles, "600"},
    {"Rebalance", "rebalance", kRamp, kSteps, "600"},
    {"Matched", "matched", kRamp, kPoints, "600"},
    {"Trimmed", "trimmed", kZigzag, kSteps, "600"},
    {"Stirred", "nominal", kStirred, "", "600"},
    {"SteepAmbient", "nominal", kSteep, "", "300"},
};
const std::vector<Case> kLoops = {
    {"StartUp", "nominal", kRoom, "", "20"},
    {"Steps", "nominal", kRoom, kSteps},
    {"Points", "nominal", kRamp, kPoints},
    {"Cross", "nominal", kRoom, kCross},
    {"Gravity", "nominal", kRoom, kGravity},
    {"PowerCycles", "nominal", kRoom, kCycles},
    {"Rebalance", "rebalance", kRamp, kSteps},
    {"Trimmed", "trimmed", kZigzag, kSteps},
};
const std::vector<Case> kWithMemory = {
    {"LifelikeRest", "lifelike", kRoom, "", "300"},
    {"LifelikeRamp", "lifelike", kRamp, kSteps, "600"},
    {"LifelikeZigzag", "lifelike", kZigzag, kPoints, "600"},
    {"LifelikeAged", "lifelike", kRamp, kAge, "600"},
    {"LifelikeHistory", "lifelike", kRoom, kHistory, "600"},
    {"LifelikeCross", "lifelike", kZigzag, kCross, "600"},
    {"LifelikeWithModes", "lifelike_with_modes", kZigzag, kSteps, "300"},
};

void expect_near(double stepped, double run, double tolerance,
                 const std::string& column, double t) {
  if (std::isnan(run)) {
    EXPECT_TRUE(std::isnan(stepped)) << column << " at " << t << " s";
  } else {
    EXPECT_NEAR(stepped, run, tolerance) << column << " at " << t << " s";
  }
}

// A gyro whose resolutions hide nothing: a difference of 1e-12 would turn into
// one of their steps.
DeviceParameters fine_device(const char* name) {
  return shipped_device(
      name, {"readout.adc_bits=32", "readout.drive_frequency_resolution_Hz=0",
             "readout.drive_voltage_resolution_V=0",
             "readout.quadrature_resolution_deg_per_s=0",
             "temperature_sensor.resolution_K=0"});
}

constexpr double kStartUpTolerance = 2e-3;  // [deg/s]

bool starts_at(const ScenarioPlan& plan, double t) {
  return std::ranges::any_of(plan.powered, [t](const PowerInterval& power) {
    return t >= power.on && t < power.on + 1;
  });
}

void expect_the_run(const Case& c, double tolerance,
                    Fidelity fidelity = Fidelity::kQuasistatic) {
  const DeviceParameters device = fine_device(c.device);
  ScenarioPlan plan = scenario_from(c.extra, c.ambient, c.duration);
  plan.fidelity = fidelity;
  const Recording run = simulated(plan, device);
  const std::vector<StepSample> steps =
      replayed(plan, stepper_model(make_gyro(device)));
  ASSERT_EQ(steps.size(), run.time.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    const StepSample& s = steps[k];
    const double t = run.time[k];
    const auto expect = [&](const std::string& column, double stepped,
                            double within) {
      expect_near(stepped, column_values(run, column)[k], within, column, t);
    };
    ASSERT_NEAR(s.time, t, 1e-9);
    for (std::size_t node = 0; node < kThermalNodeCount; ++node)
      expect(fmt::format("true_{}_temperature", kThermalNodeNames[node]),
             s.true_node_temperature[node], 2e-5);
    const bool powered = (run.status[k] & kUnpowered) == 0;
    if (s.powered != powered) {
      // At a switch the run shows what comes, and the step what was.
      EXPECT_TRUE(std::ranges::any_of(plan.powered, [t](PowerInterval p) {
        return p.on == t || p.off == t;
      })) << t;
      continue;
    }
    // The start-up of the loops, of which a run has its own error.
    const double within = fidelity == Fidelity::kEnvelope && starts_at(plan, t)
                              ? kStartUpTolerance
                              : tolerance;
    expect("true_bias", s.true_bias, within);
    expect("rate", s.rate, within);
    expect("temperature", s.temperature, 2e-5);
    expect("drive_frequency", s.drive_frequency, 1e-4);
    expect("drive_voltage", s.drive_voltage, 1e-4);
    expect("quadrature", s.quadrature, 5e-3);
    EXPECT_EQ(s.saturated, (run.status[k] & kOutputSaturated) != 0);
    if (testing::Test::HasFailure()) return;
  }
}

class Replay : public testing::TestWithParam<Case> {};
TEST_P(Replay, StepsCutAtEveryCornerShowWhatTheRunShows) {
  expect_the_run(GetParam(), 5e-6);
}

class ReplayOfLoops : public testing::TestWithParam<Case> {};
TEST_P(ReplayOfLoops, StepsCutAtEveryCornerShowWhatTheRunShows) {
  expect_the_run(GetParam(), 2e-5, Fidelity::kEnvelope);
}

class ReplayWithMemory : public testing::TestWithParam<Case> {};
TEST_P(ReplayWithMemory, StepsCutAtEveryCornerShowWhatTheRunShows) {
  expect_the_run(GetParam(), 5e-5);
}

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Of, Replay, testing::ValuesIn(kWithoutMemory),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Of, ReplayOfLoops, testing::ValuesIn(kLoops), name_of);
INSTANTIATE_TEST_SUITE_P(Of, ReplayWithMemory, testing::ValuesIn(kWithMemory),
                         name_of);

}  // namespace
}  // namespace beamgyro::internal::replay_test
