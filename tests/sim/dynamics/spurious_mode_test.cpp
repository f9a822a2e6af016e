// SPDX-License-Identifier: MIT
// Spurious modes in the static solution. Values without a closed form are those
// of an independent model that has the mode as a third oscillator.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "config/units.h"
#include "random/random_stream.h"
#include "sim/dynamics/static_solution.h"
#include "tests/sim/dynamics/spurious_units.h"

namespace beamgyro::internal {
namespace {

double bias_at(const Gyro& gyro, double celsius) {
  const double T = celsius + kZeroCelsius;
  return electronics_at(gyro, T)
             .output(beam_signal(gyro, T, {}).demodulated)
             .rate /
         kDegree;
}

BeamSignal signal_at(const Gyro& gyro, double celsius) {
  return beam_signal(gyro, celsius + kZeroCelsius, {});
}

struct Expected {
  double celsius, with, without;  // [degC] [deg/s]
};

TEST(Verification, V60BiasOfUnitA) {
  const Gyro with = kUnitA.gyro(), without = without_spurious_modes(with);
  for (const Expected& e : {Expected{-1, 1.982311, 1.917280},
                            {5, 1.805547, 1.168323},
                            {7, 1.320872, 0.986590},
                            {17, 0.514342, 0.502011}}) {
    EXPECT_NEAR(bias_at(with, e.celsius), e.with, 5e-4) << e.celsius;
    EXPECT_NEAR(bias_at(without, e.celsius), e.without, 5e-4) << e.celsius;
  }
}

TEST(Verification, V61BiasOfUnitB) {
  const Gyro with = kUnitB.gyro(), without = without_spurious_modes(with);
  for (const Expected& e : {Expected{-27.5, 3.720965, 3.770765},
                            {-20, 3.807858, 4.330747},
                            {-17.5, 4.134049, 4.378863},
                            {-5, 2.576412, 2.587424}}) {
    EXPECT_NEAR(bias_at(with, e.celsius), e.with, 1e-3) << e.celsius;
    EXPECT_NEAR(bias_at(without, e.celsius), e.without, 1e-3) << e.celsius;
  }
}

TEST(Verification, V62BiasOfUnitC) {
  const Gyro gyro = kUnitC.gyro();
  for (const auto& [celsius, bias] : {std::pair{28.5, 2.049156},
                                      {30.0, 16.556348},
                                      {30.5, 8.585858},
                                      {33.0, 0.995106}}) {
    EXPECT_NEAR(bias_at(gyro, celsius), bias, 1e-3 * bias) << celsius;
  }
}

struct Crossing {
  SpuriousUnit unit;
  double height;        // [deg/s]
  double voltage;       // dV/V
  double lower, upper;  // extremes of df [Hz]
  double digit;         // half of their last digit [Hz]
};

class V63Crossing : public testing::TestWithParam<Crossing> {};

// The closed forms are of first order; the second order is 10 % of the smallest
// of these heights.
TEST_P(V63Crossing, HasTheHeightsOfTheClosedFormAndOfTheSolution) {
  const auto& [unit, height, voltage, lower, upper, digit] = GetParam();
  const Gyro with = unit.gyro(), without = without_spurious_modes(with);
  const ModalParameters modal = modal_at(without, kCalibrationTemperature);
  const double e_x = unit.coupling_drive, e_y = unit.coupling_sense;
  const double eta = unit.loss_factor;

  const double top =
      bias_at(with, unit.crossing) - bias_at(without, unit.crossing);
  EXPECT_NEAR(top, height, 1e-3 * std::abs(height));
  const double first_order = e_x * e_y * with.spurious_reference /
                             (2 * eta * with.beam.angular_gain) / kDegree;
  EXPECT_NEAR(top, first_order, 0.1 * std::abs(first_order));  // (13.4)

  const double V = signal_at(without, unit.crossing).drive_voltage;
  const double rise = signal_at(with, unit.crossing).drive_voltage / V - 1;
  EXPECT_NEAR(rise, voltage, 1e-3 * voltage);
  const double T = unit.crossing + kZeroCelsius;
  const double Q_x = signal_at(without, unit.crossing).drive_frequency *
                     modal.mass / modal_at(without, T).damping(0, 0);
  EXPECT_NEAR(rise, e_x * e_x * Q_x / eta, 0.1 * rise);  // (13.6)

  double least = 0, most = 0;
  for (double x = -1.5; x <= 1.5; x += 0.01) {
    const double width = eta / std::abs(unit.detuning_tc + 1.5e-5);  // [K]
    const double celsius = unit.crossing + x * width / 2;
    const double df = (signal_at(with, celsius).drive_frequency -
                       signal_at(without, celsius).drive_frequency) /
                      (2 * std::numbers::pi);
    least = std::min(least, df);
    most = std::max(most, df);
  }
  EXPECT_NEAR(least, lower, digit + 1e-3 * std::abs(lower));
  EXPECT_NEAR(most, upper, digit + 1e-3 * upper);
  const double half =
      e_x * e_x / (4 * eta) * with.spurious_reference / (2 * std::numbers::pi);
  EXPECT_NEAR(most, half, 0.1 * half);  // (13.6)
  EXPECT_NEAR(least, -half, 0.1 * half);
}

INSTANTIATE_TEST_SUITE_P(Verification, V63Crossing,
                         testing::Values(Crossing{kUnitA, 0.637, 3.035e-4,
                                                  -0.875e-3, 0.917e-3, 5e-7},
                                         Crossing{kUnitB, -0.523, 1.490e-3,
                                                  -4.01e-3, 4.16e-3, 5e-6},
                                         Crossing{kUnitC, 15.945, 7.573e-3,
                                                  -22.0e-3, 22.8e-3, 5e-5}));

}  // namespace
}  // namespace beamgyro::internal
