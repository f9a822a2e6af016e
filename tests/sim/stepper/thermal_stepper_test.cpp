// SPDX-License-Identifier: MIT
#include "sim/stepper/thermal_stepper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/numerics/simulation_failure.h"
#include "sim/thermal/thermal_run.h"
#include "tests/sim/stepper/shipped_device.h"

namespace beamgyro::internal::thermal_stepper_test {
namespace {

// From 0 to 600 s: off for 20 s, on for 300 s, off, on from 400 s, in still air
// that goes from -10 to 40 degC.
ThermalLoad load_of(const TrimmedGyro& gyro) {
  const DriveHeating heating = drive_heating(gyro);
  return {.ambient = PiecewiseLinear({0, 600}, {263.15, 313.15}),
          .powered = {{20, 320}, {400}},
          .mechanical_power = heating.mechanical,
          .dielectric_power = heating.dielectric};
}

// The largest difference [K] to CVODE at a tolerance of 1e-12 K, at every
// `step` [s].
double error_of(const TrimmedGyro& gyro, double step) {
  const ThermalLoad load = load_of(gyro);
  std::vector<double> times;
  for (int k = 0; k * step <= 600; ++k) times.push_back(k * step);
  const ThermalHistory exact = simulate_temperatures(
      ThermalNetwork(gyro.device.thermal), load, times, 1e-12);
  const ThermalStepper stepper(gyro, false);
  ThermalStepper::State y = ThermalStepper::State::Zero();
  y.head<kThermalNodeCount>().setConstant(263.15);
  double error = 0;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    const bool powered = powered_at(load.powered, times[k]);
    if (powered && k > 0 && !powered_at(load.powered, times[k - 1]))
      y(kThermalNodeCount) = 0;
    const std::int64_t parts = stepper.parts(step);
    for (std::int64_t i = 0; i < parts; ++i) {
      const auto at = [&](std::int64_t part) {
        return load.ambient.value(times[k] + step * static_cast<double>(part) /
                                                 static_cast<double>(parts));
      };
      y = stepper.stepped(y, at(i), at(i + 1), powered,
                          step / static_cast<double>(parts));
    }
    for (std::size_t node = 0; node < kThermalNodeCount; ++node)
      error = std::max(error, std::abs(y(static_cast<Eigen::Index>(node)) -
                                       exact.temperature[node][k + 1]));
  }
  return error;
}

TEST(ThermalStepper, FollowsTheNetworkInStepsOfAnyLength) {
  for (const char* name : {"nominal", "trimmed", "metal_mount"}) {
    const TrimmedGyro gyro = make_gyro(shipped_device(name));
    for (const double step : {0.02, 0.1, 1.0, 10.0})
      EXPECT_LT(error_of(gyro, step), 1e-8) << name << " " << step;
  }
}

// The right-hand side bends where the heater reaches a limit.
TEST(ThermalStepper, FollowsAnOven) {
  const TrimmedGyro gyro = make_gyro(shipped_device("oven"));
  for (const double step : {0.02, 0.1, 1.0})
    EXPECT_LT(error_of(gyro, step), 1e-6) << step;
}

TEST(ThermalStepper, ANodeThatIsTooLightIsRefused) {
  const TrimmedGyro gyro = make_gyro(
      shipped_device("nominal", {"thermal.pzt_heat_capacity_J_per_K=1e-6"}));
  EXPECT_THROW(ThermalStepper(gyro, false), SimulationFailure);
}

}  // namespace
}  // namespace beamgyro::internal::thermal_stepper_test
