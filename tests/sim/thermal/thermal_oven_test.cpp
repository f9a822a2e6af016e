// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "sim/thermal/thermal_ode.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal::thermal_oven_test {
namespace {

constexpr double kZeroCelsius = 273.15;  // [K]

ThermalParameters ovenised() {
  ThermalParameters parameters;
  parameters.mount_housing_conductance = 0.015;
  parameters.beam_housing_conductance = 0;
  parameters.beam_mount_conductance = 8.5e-3;
  parameters.oven.emplace();
  return parameters;
}

std::vector<double> seconds(int count) {
  std::vector<double> times(static_cast<std::size_t>(count));
  std::iota(times.begin(), times.end(), 0.0);
  return times;
}

ThermalHistory warm_up(double ambient_degC, int duration) {
  return simulate_temperatures(
      ThermalNetwork{ovenised()},
      {.ambient = PiecewiseLinear::constant(ambient_degC + kZeroCelsius),
       .powered = {{0.0}},
       .mechanical_power = 1e-4},
      seconds(duration));
}

TEST(ThermalOven, HoldsTheMountAtTheSetPointFromCold) {
  const ThermalHistory history = warm_up(-40, 3600);
  EXPECT_NEAR(history.temperature[kMount].back(), 65 + kZeroCelsius, 0.001);
  // About 1.5 W; the housing heated by the electronics too saves some of it.
  EXPECT_NEAR(history.heater_power.back(), 1.5, 0.2);
}

TEST(ThermalOven, HeaterPowerIsWhatLeavesTheMount) {
  const ThermalHistory history = warm_up(-40, 7200);
  const double mount = history.temperature[kMount].back();
  const double housing = history.temperature[kHousing].back();
  // The beam's own 0.1 mW reaches the mount through the pins.
  EXPECT_NEAR(history.heater_power.back(), 0.015 * (mount - housing) - 1e-4,
              1e-6);
}

TEST(ThermalOven, BeamIsReadyAfterTwelveToFifteenMinutes) {
  const ThermalHistory history = warm_up(-40, 3600);
  const std::vector<double>& beam = history.temperature[kBeam];
  const double band = 0.02 * (beam.back() - beam.front());  // settled: 2 %
  std::size_t ready = beam.size();
  while (std::abs(beam[ready - 1] - beam.back()) < band) --ready;
  EXPECT_GE(ready, 12u * 60);
  EXPECT_LE(ready, 15u * 60);
}

TEST(ThermalOven, HeaterStaysWithinItsLimitsAndTheMountHardlyOvershoots) {
  const ThermalHistory history = warm_up(-40, 3600);
  EXPECT_EQ(history.heater_power.front(), 3.0);
  for (std::size_t k = 0; k < 3600; ++k) {
    EXPECT_GE(history.heater_power[k], 0.0);
    EXPECT_LE(history.heater_power[k], 3.0);
    // An integral wound up to full power would overshoot by 1.5 K.
    EXPECT_LT(history.temperature[kMount][k], 65.1 + kZeroCelsius);
  }
}

TEST(ThermalOven, RestsWhileUnpoweredAndStartsAgain) {
  const ThermalHistory history =
      simulate_temperatures(ThermalNetwork{ovenised()},
                            {.ambient = PiecewiseLinear::constant(kZeroCelsius),
                             .powered = {{10, 2000}, {9000}}},
                            seconds(12000));
  EXPECT_EQ(history.heater_power[9], 0.0);
  EXPECT_EQ(history.heater_power[10], 3.0);
  EXPECT_EQ(history.heater_power[2000], 0.0);
  EXPECT_LT(history.temperature[kMount][8999], 5 + kZeroCelsius);
  EXPECT_EQ(history.heater_power[9000], 3.0);
  EXPECT_NEAR(history.temperature[kMount].back(), 65 + kZeroCelsius, 0.01);
}

TEST(ThermalOven, StartsWithAnEmptyIntegralAfterAShortBreak) {
  const ThermalHistory history =
      simulate_temperatures(ThermalNetwork{ovenised()},
                            {.ambient = PiecewiseLinear::constant(kZeroCelsius),
                             .powered = {{0, 2000}, {2001}}},
                            seconds(2100));
  const double error = 65 + kZeroCelsius - history.temperature[kMount][2001];
  EXPECT_GT(error, 0.1);
  EXPECT_NEAR(history.heater_power[2001], 1.0 * error, 1e-9);
}

TEST(ThermalOven, RunSettlesInTheSteadyState) {
  const ThermalNetwork network{ovenised()};
  const OvenSteadyState steady = oven_steady_state(
      network, *network.parameters().oven, network.powered_heating(1e-4, 0),
      {kZeroCelsius - 40, false});
  const ThermalHistory history = warm_up(-40, 3 * 3600);
  for (int i = 0; i < kThermalNodeCount; ++i) {
    EXPECT_NEAR(history.temperature[static_cast<std::size_t>(i)].back(),
                steady.temperature(i), 1e-5);
  }
  EXPECT_NEAR(history.heater_power.back(), steady.heater_power, 1e-5);
}

TEST(ThermalOven, SteadyStateSaturatesWhereTheHeaterCannotReach) {
  const ThermalNetwork network{ovenised()};
  const auto at = [&](double ambient_degC, double max_power) {
    ThermalOven oven;
    oven.max_power = max_power;
    return oven_steady_state(network, oven, network.powered_heating(0, 0),
                             {ambient_degC + kZeroCelsius, false});
  };
  const OvenSteadyState weak = at(-40, 0.5);
  EXPECT_EQ(weak.heater_power, 0.5);
  EXPECT_LT(weak.temperature(kMount), 65 + kZeroCelsius);
  const OvenSteadyState hot = at(75, 3.0);
  EXPECT_EQ(hot.heater_power, 0.0);
  EXPECT_GT(hot.temperature(kMount), 75 + kZeroCelsius);
}

TEST(ThermalOven, SlopesAgreeWithCentralDifferences) {
  const ThermalOven oven;
  const double h = 1e-5;
  // Saturated high, on the way into it, free, and both ways below zero.
  const double points[][2] = {{300.0, 0.0},   {335.05, 0.0}, {335.0, -0.05},
                              {337.9, 1.1},   {338.5, 0.2},  {338.5, 1.0},
                              {339.55, 1.25}, {345.0, 1.0},  {338.0, 3.5}};
  for (const auto& [mount, integral] : points) {
    const OvenAction action = oven_action(oven, mount, integral);
    const OvenAction up = oven_action(oven, mount + h, integral);
    const OvenAction down = oven_action(oven, mount - h, integral);
    EXPECT_NEAR(action.power_per_mount, (up.power - down.power) / (2 * h),
                1e-8);
    EXPECT_NEAR(action.integral_rate_per_mount,
                (up.integral_rate - down.integral_rate) / (2 * h), 1e-6)
        << mount << ", " << integral;
    const OvenAction more = oven_action(oven, mount, integral + h);
    const OvenAction less = oven_action(oven, mount, integral - h);
    EXPECT_NEAR(action.power_per_integral, (more.power - less.power) / (2 * h),
                1e-8);
    EXPECT_NEAR(action.integral_rate_per_integral,
                (more.integral_rate - less.integral_rate) / (2 * h), 1e-6)
        << mount << ", " << integral;
  }
}

TEST(ThermalOven, IntegralRestsInSaturationAndRecoversFromIt) {
  const ThermalOven oven;
  EXPECT_EQ(oven_action(oven, 300.0, 0.0).integral_rate, 0.0);
  EXPECT_EQ(oven_action(oven, 345.0, 0.0).integral_rate, 0.0);
  EXPECT_LT(oven_action(oven, 338.2, 5.0).integral_rate, 0.0);
  EXPECT_GT(oven_action(oven, 338.0, -5.0).integral_rate, 0.0);
}

}  // namespace
}  // namespace beamgyro::internal::thermal_oven_test
