// SPDX-License-Identifier: MIT
// Spurious modes in the static solution. Values without a closed form are those
// of an independent model that has the mode as a third oscillator.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "config/units.h"
#include "random/random_stream.h"
#include "sim/dynamics/static_solution.h"
#include "sim/numerics/simulation_failure.h"
#include "tests/config/rejection.h"
#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/dynamics/spurious_units.h"

namespace beamgyro::internal {
namespace {

double bias_at(const TrimmedGyro& gyro, double celsius) {
  const double T = celsius + kZeroCelsius;
  return electronics_at(gyro, T)
             .output(beam_signal(gyro, T, {}).demodulated)
             .rate /
         kDegree;
}

BeamSignal signal_at(const TrimmedGyro& gyro, double celsius) {
  return beam_signal(gyro, celsius + kZeroCelsius, {});
}

struct Expected {
  double celsius, with, without;  // [degC] [deg/s]
};

TEST(Verification, V60BiasOfUnitA) {
  const TrimmedGyro with = kUnitA.gyro(),
                    without = without_spurious_modes(with);
  for (const Expected& e : {Expected{-1, 1.982311, 1.917280},
                            {5, 1.805547, 1.168323},
                            {7, 1.320872, 0.986590},
                            {17, 0.514342, 0.502011}}) {
    EXPECT_NEAR(bias_at(with, e.celsius), e.with, 5e-4) << e.celsius;
    EXPECT_NEAR(bias_at(without, e.celsius), e.without, 5e-4) << e.celsius;
  }
}

TEST(Verification, V61BiasOfUnitB) {
  const TrimmedGyro with = kUnitB.gyro(),
                    without = without_spurious_modes(with);
  for (const Expected& e : {Expected{-27.5, 3.720965, 3.770765},
                            {-20, 3.807858, 4.330747},
                            {-17.5, 4.134049, 4.378863},
                            {-5, 2.576412, 2.587424}}) {
    EXPECT_NEAR(bias_at(with, e.celsius), e.with, 1e-3) << e.celsius;
    EXPECT_NEAR(bias_at(without, e.celsius), e.without, 1e-3) << e.celsius;
  }
}

TEST(Verification, V62BiasOfUnitC) {
  const TrimmedGyro gyro = kUnitC.gyro();
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
  const TrimmedGyro with = unit.gyro(), without = without_spurious_modes(with);
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

double uniform(RandomStream& stream, double low, double high) {
  return low + (high - low) * stream.uniform();
}

TEST(Verification, V64LossesArePositiveForEverySetOfModes) {
  const TrimmedGyro gyro = make_gyro(nominal_device());
  RandomStream stream(64, 0, 0, kDeviceDrawStream);
  for (int set = 0; set < 10000; ++set) {
    std::vector<SpuriousModeParameters> modes(
        static_cast<std::size_t>(uniform(stream, 1, 17)));
    for (SpuriousModeParameters& mode : modes) {
      mode.detuning = uniform(stream, -0.1, 0.1);
      mode.detuning_tc = uniform(stream, -5e-3, 5e-3);
      mode.loss_factor = std::pow(10, uniform(stream, -5, -0.3));
      mode.coupling_drive = uniform(stream, -0.01, 0.01);
      mode.coupling_sense = uniform(stream, -0.01, 0.01);
      mode.follows_housing = uniform(stream, 0, 1) < 0.5;
    }
    const double T = uniform(stream, 175, 470);
    ModalParameters modal = modal_at(gyro, std::clamp(T, 230.0, 350.0));
    const double w_0 = std::sqrt(modal.stiffness(0, 0) / modal.mass);
    modal.spurious = spurious_resonances(modes, w_0, modal.mass,
                                         {T, T + uniform(stream, -20, 20)});
    const double omega = w_0 * uniform(stream, 0.9, 1.1);
    const Eigen::Matrix2d loss = omega * damping_at(modal, omega);
    EXPECT_GT(loss(0, 0), 0);
    EXPECT_GT(loss.determinant(), 0);
    // That of the modes alone, but for roundoff of its sum.
    const Eigen::Matrix2d added =
        spurious_stiffness(modal.spurious, omega).value.imag();
    EXPECT_GE(added(0, 0), 0);
    EXPECT_GE(added.determinant(), -1e-14 * added(0, 0) * added(1, 1));
  }
}

// Also the derivative that Newton's method and the noise use.
TEST(SpuriousMode, SlopeOfItsStiffnessIsThatOfDifferences) {
  const std::vector<SpuriousResonance> modes = spurious_resonances(
      kUnitB.gyro().device.spurious_modes, 57000, 7e-4, {252.15, 252.15});
  const double omega = std::sqrt(modes[0].square) - 20, h = 0.5;
  const auto at = [&](double w) { return spurious_stiffness(modes, w).value; };
  const Eigen::Matrix2cd slope = (8 * (at(omega + h) - at(omega - h)) -
                                  (at(omega + 2 * h) - at(omega - 2 * h))) /
                                 (12 * h);
  EXPECT_LT((spurious_stiffness(modes, omega).slope - slope).norm(),
            1e-6 * slope.norm());
}

double bias_of(const TrimmedGyro& gyro, double T,
               const ModalParameters& modal) {
  return electronics_at(gyro, T)
             .output(beam_signal(gyro, modal, {}).demodulated)
             .rate /
         kDegree;
}

// (13.2) with the age and the slip as part of d_s.
TEST(SpuriousMode, AgeAndSlipMoveItAsADetuningDoes) {
  TrimmedGyro aged = kUnitA.gyro(), moved = aged;
  aged.device.spurious_modes[0].drift = 3e-3;
  aged.device.spurious_modes[0].slip = -2e-3;
  moved.device.spurious_modes[0].detuning += 2 * 3e-3 - 0.5 * 2e-3;
  const MemoryState memory{.hysteresis = 0.5, .decades = 2};
  for (const double celsius : {-20.0, 5.0, 25.0, 35.0}) {
    const double T = celsius + kZeroCelsius;
    const double bias = bias_of(moved, T, modal_at(moved, T));
    EXPECT_NEAR(bias_of(aged, T, modal_at(aged, T, memory)), bias, 1e-12);
    EXPECT_GT(std::abs(bias_at(aged, celsius) - bias), 1e-5) << celsius;
  }
}

// A crossing at 5 degC comes when the housing has 5 degC, wherever the beam is.
TEST(SpuriousMode, FollowsTheHousing) {
  TrimmedGyro gyro = kUnitA.gyro(), none = without_spurious_modes(gyro);
  gyro.device.spurious_modes[0].follows_housing = true;
  const double beam = 8 + kZeroCelsius;
  const auto bump = [&](double housing) {
    const SpuriousTemperatures at{beam, housing + kZeroCelsius};
    return bias_of(gyro, beam, modal_at(gyro, at)) -
           bias_of(none, beam, modal_at(none, beam));
  };
  EXPECT_GT(std::abs(bump(5)), 3 * std::abs(bump(8)));
  EXPECT_GT(std::abs(bump(5)), 3 * std::abs(bump(2)));
  gyro.device.spurious_modes[0].follows_housing = false;
  EXPECT_EQ(bump(5), bump(8));
}

std::string refusal(double loss_factor, double coupling) {
  SpuriousUnit unit = kUnitA;
  unit.loss_factor = loss_factor;
  unit.coupling_drive = coupling;
  return rejection<SimulationFailure>([&] { unit.gyro(); });
}

// With Q_x = 763: 0.3 is reached at e_x = 6.27e-4, e_x = eta_s at 1e-4.
TEST(SpuriousMode, CouplingsThatMakeTheLockAmbiguousAreRefused) {
  EXPECT_TRUE(
      holds(refusal(1e-3, 6.4e-4), "spurious_mode.wire.coupling_drive"));
  EXPECT_TRUE(holds(refusal(1e-3, 6.4e-4), "e_x^2 Q_x/eta_s = 0.312"));
  EXPECT_TRUE(holds(refusal(1e-4, -1.1e-4), "|e_x|/eta_s = 1.1"));
  EXPECT_NO_THROW(SpuriousUnit(kUnitA).gyro());
  SpuriousUnit near = kUnitA;
  near.coupling_drive = 6.2e-4;
  EXPECT_NO_THROW(near.gyro());
}

// At the limit the phase has one zero at every temperature near the crossing.
TEST(SpuriousMode, TheStrongestModeThatIsAllowedHasOneLock) {
  for (const auto& [eta, e] : {std::pair{1e-3, 6.2e-4}, {1e-4, 0.99e-4}}) {
    SpuriousUnit unit = kUnitA;
    unit.loss_factor = eta;
    unit.coupling_drive = e;
    const TrimmedGyro gyro = unit.gyro();
    for (double T = 270; T < 286; T += 0.1) {
      const ModalParameters modal = modal_at(gyro, T);
      const StaticSolution s = static_solution(gyro, modal, {});
      int zeros = 0;
      double before = 0;
      for (double w = s.drive_frequency - 200; w < s.drive_frequency + 200;
           w += 0.05) {
        const Eigen::Vector2cd u =
            reference::inverse(dynamic_stiffness(modal, w, {})) *
            modal.coupling[kDrive];
        const Complex lock =
            -std::polar(1.0, std::numbers::pi / 2 - gyro.loop.pll_phase) *
            Complex(modal.coupling[kFeedback].transpose() * u);
        const double delta = std::arg(lock);
        zeros += before * delta < 0 && std::abs(delta) < 1;
        before = delta;
      }
      EXPECT_EQ(zeros, 1) << T << ' ' << eta;
    }
  }
}

}  // namespace
}  // namespace beamgyro::internal
