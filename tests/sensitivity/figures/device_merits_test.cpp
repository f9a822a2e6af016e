// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "compensation/models/polynomial.h"
#include "config/document.h"
#include "config/units.h"
#include "sensitivity/figures/figure_of_merit.h"
#include "sim/device/device_file.h"
#include "sim/dynamics/characteristic.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/thermal/thermal_run.h"

namespace beamgyro::internal::device_merits_test {
namespace {

DeviceParameters nominal() {
  return read_device(ConfigDocument::read(std::string(BEAMGYRO_SCENARIOS) +
                                          "/devices/nominal.toml"));
}

double merit_of(const DeviceParameters& device, Merit merit,
                const MeritOptions& options = {}) {
  return device_merits(device, std::vector{merit}, options).front();
}

TEST(DeviceMerits, TheCurveIsThatOfCharacterise) {
  const TrimmedGyro gyro = make_gyro(nominal());
  const CurveGrid grid{-40, 50, 4};
  const StaticCurve curve = static_curve(gyro, grid);
  const Eigen::ArrayXd slope = scale_factor_curve(gyro, grid);
  const std::vector<double> temperatures = {-40, -10, 20, 50};
  const auto rows = characteristic(gyro, temperatures);
  for (Eigen::Index k = 0; k < 4; ++k) {
    const CharacteristicRow& row = rows[static_cast<std::size_t>(k)];
    EXPECT_NEAR(curve.bias(k), row[0], 1e-11 * (1 + std::abs(row[0])));
    EXPECT_NEAR(curve.drive_frequency(k), row[3], 1e-8);
    EXPECT_NEAR(curve.drive_voltage(k), row[7], 1e-10);
    EXPECT_NEAR(slope(k), row[8], 1e-11);
  }
}

TEST(DeviceMerits, ALinearOffsetAloneLeavesACubicNothingMore) {
  DeviceParameters device = nominal();
  const MeritOptions options;
  const double before = merit_of(device, Merit::kCubicRms, options);
  const StaticCurve curve = static_curve(make_gyro(device), options.grid);
  device.readout.offset_tc += 0.1 * kDegree;
  // A cubic takes a straight line whole: rounding of 9 deg/s remains.
  EXPECT_NEAR(merit_of(device, Merit::kCubicRms, options), before, 1e-12);
  const Eigen::ArrayXd tilted = curve.bias + 0.1 * (curve.temperature - 25);
  EXPECT_NEAR(merit_of(device, Merit::kBiasPeakToPeak, options),
              tilted.maxCoeff() - tilted.minCoeff(), 1e-9);
}

TEST(DeviceMerits, ThirtySevenTemperaturesFindThePeaks) {
  MeritOptions fine;
  fine.grid.count = 1801;
  const DeviceParameters device = nominal();
  for (const Merit merit :
       {Merit::kBiasPeakToPeak, Merit::kScaleFactorDrift, Merit::kQuadrature}) {
    const double exact = merit_of(device, merit, fine);
    EXPECT_NEAR(merit_of(device, merit), exact, 0.01 * exact);
  }
  // The ends, where a cubic fits worst, have twice the weight of a fine grid.
  const double exact = merit_of(device, Merit::kCubicRms, fine);
  EXPECT_NEAR(merit_of(device, Merit::kCubicRms), exact, 0.05 * exact);
}

TEST(DeviceMerits, TheWarmUpEndsAtTheTemperaturesOfALongRun) {
  const TrimmedGyro gyro = make_gyro(nominal());
  const DriveHeating heating = drive_heating(gyro);
  ThermalLoad load{PiecewiseLinear::constant(25 + kZeroCelsius)};
  load.powered = {{0}};
  load.mechanical_power = heating.mechanical;
  load.dielectric_power = heating.dielectric;
  const std::vector<double> times = {1e5};
  const ThermalHistory history =
      simulate_temperatures(ThermalNetwork(gyro.device.thermal), load, times);
  const auto bias = [&](double beam, double board) {
    return electronics_at(gyro, board)
               .output(beam_signal(gyro, beam, {}).demodulated)
               .rate /
           kDegree;
  };
  const double ambient = 25 + kZeroCelsius;
  // Temperatures to 1e-5 K, the bias changes by less than 1 deg/s each K.
  EXPECT_NEAR(
      merit_of(gyro.device, Merit::kWarmUpChange),
      bias(history.temperature[kBeam][0], history.temperature[kBoard][0]) -
          bias(ambient, ambient),
      1e-4);
}

TEST(DeviceMerits, ACompensatorThatKnowsTheCurveLeavesTheCubicsResidual) {
  DeviceParameters device = nominal();
  device.temperature_sensor.offset = 0;
  MeritOptions options;
  const StaticCurve curve = static_curve(make_gyro(device), options.grid);
  const Eigen::ArrayXXd x = curve.temperature;
  auto compensator = std::make_shared<FittedCompensator>();
  compensator->inputs = {parse_input("temperature_lowpass(100)")};
  compensator->bias.input_scales = {Scale{}};
  compensator->bias.function = fit_polynomial(x, curve.bias, 3);
  compensator->baseline = compensator->bias;
  options.compensator = compensator;
  EXPECT_NEAR(merit_of(device, Merit::kCompensatorRms, options),
              merit_of(device, Merit::kCubicRms, options), 1e-9);
}

TEST(DeviceMerits, ADeviceThatDoesNotLockFails) {
  DeviceParameters device = nominal();
  device.drive.pll_phase = 3;  // no mode gives that phase
  EXPECT_THROW(merit_of(device, Merit::kBiasPeakToPeak), SimulationFailure);
}

}  // namespace
}  // namespace beamgyro::internal::device_merits_test
