// SPDX-License-Identifier: MIT
#include "sim/dynamics/gyro.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal::gyro_test {
namespace {

constexpr double kT0 = kCalibrationTemperature;

double bias(const TrimmedGyro& gyro, double celsius) {  // [deg/s]
  const double T = celsius + kZeroCelsius;
  return zero_rate_output(gyro, T) / kDegree;
}

TEST(Verification, V41ZeroRateOutputOfTheNominalUnit) {
  const TrimmedGyro gyro = make_gyro(verification_device());
  const std::pair<double, double> table[] = {
      {-40, 3.88}, {-30, 3.67}, {-20, 4.33}, {-10, 3.53}, {0, 1.77},
      {10, 0.77},  {25, 0.50},  {40, 0.96},  {50, 1.02},  {60, -3.1}};
  for (const auto& [celsius, expected] : table)
    EXPECT_NEAR(bias(gyro, celsius), expected, 0.02) << celsius << " degC";
}

TEST(TrimmedGyro, DriveFrequencyAndQualityOfTheNominalUnit) {
  const TrimmedGyro gyro = make_gyro(verification_device());
  const auto frequency = [&](double celsius) {
    return beam_signal(gyro, celsius + kZeroCelsius, {}).drive_frequency /
           (2 * std::numbers::pi);
  };
  EXPECT_NEAR(frequency(-40), 9090.25, 0.02);
  EXPECT_NEAR(frequency(25), 9081.50, 0.02);
  EXPECT_NEAR(frequency(50), 9078.87, 0.02);

  const std::pair<double, double> table[] = {
      {-40, 1012}, {-20, 828}, {0, 775}, {25, 763}, {50, 777}, {60, 621}};
  for (const auto& [celsius, expected] : table) {
    const ModalParameters modal = modal_at(gyro, celsius + kZeroCelsius);
    const double Q = 2 * std::numbers::pi * frequency(celsius) * modal.mass /
                     modal.damping(0, 0);
    EXPECT_NEAR(Q / expected, 1, 0.005) << celsius << " degC";
  }
}

TEST(TrimmedGyro, TrimsAreWhatTheFactoryWouldMeasure) {
  const TrimmedGyro gyro = make_gyro(
      nominal_device({"readout.quadrature_trim_deg_per_s=-25",
                      "readout.offset_trim_deg_per_s=-1.5",
                      "bond.thickness_m=[20e-6, 31e-6, 25e-6, 40e-6]"}));
  const ModalParameters modal = modal_at(gyro, kT0);
  EXPECT_NEAR(-zero_rate_terms(gyro, modal).imag() / kDegree, -25, 1e-6);
  EXPECT_NEAR(bias(gyro, 25), -1.5, 1e-9);
  EXPECT_NEAR(rate_slope(gyro, modal, kT0), 1, 1e-12);
}

TEST(TrimmedGyro, AmplitudeControlCancelsThePiezoConstantInTheScaleFactor) {
  // e31 in drive, feedback and readout: their ratio keeps 1 % of its change.
  const TrimmedGyro plain = make_gyro(nominal_device());
  const TrimmedGyro strong =
      make_gyro(nominal_device({"patches.d31_tc_per_K=5e-3"}));
  const auto slope = [](const TrimmedGyro& gyro) {
    const double T = kT0 + 20;
    return rate_slope(gyro, modal_at(gyro, T), T);
  };
  EXPECT_NEAR(slope(strong) / slope(plain), 1, 6e-4);
}

TEST(TrimmedGyro, AnImpossibleTrimIsReported) {
  DeviceParameters device = nominal_device();
  device.readout.quadrature_trim = 1e9;
  EXPECT_THROW(make_gyro(device), std::runtime_error);
}

}  // namespace
}  // namespace beamgyro::internal::gyro_test
