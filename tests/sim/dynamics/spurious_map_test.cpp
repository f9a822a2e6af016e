// SPDX-License-Identifier: MIT
// The static map of units with spurious modes against the exact solution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/units.h"
#include "random/random_stream.h"
#include "sim/dynamics/smooth_modes.h"
#include "sim/dynamics/static_map.h"
#include "tests/sim/dynamics/spurious_units.h"

namespace beamgyro::internal {
namespace {

constexpr double kCold = 233.15, kHot = 323.15;  // [K]

// Modes of widths from 0.5 to 12 K that cross between -40 and 50 degC, with
// bumps as a population has them.
std::vector<SpuriousModeParameters> drawn_modes(RandomStream& stream) {
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * stream.uniform();
  };
  constexpr double kReference = 57000, kDriveTc = -1.5e-5;  // [rad/s] [1/K]
  std::vector<SpuriousModeParameters> modes(
      static_cast<std::size_t>(uniform(0, 17)));
  for (SpuriousModeParameters& mode : modes) {
    const double sign = uniform(-1, 1) < 0 ? -1 : 1;
    mode.detuning_tc =
        sign * 3e-4 * std::exp(0.6 * normal_quantile(stream.uniform()));
    const double slope = mode.detuning_tc - kDriveTc;  // [1/K]
    mode.detuning = -slope * (uniform(kCold, kHot) - kCalibrationTemperature);
    const double width = 0.5 * std::pow(24, uniform(0, 1));  // [K]
    mode.loss_factor = width * std::abs(slope);
    const double height =
        0.03 * kDegree * std::exp(normal_quantile(stream.uniform()));
    const double e = std::sqrt(2 * mode.loss_factor * height / kReference);
    mode.coupling_drive = e;
    mode.coupling_sense = uniform(-1, 1) < 0 ? -e : e;
    mode.follows_housing = false;
  }
  return modes;
}

struct Errors {
  double signal = 0, without = 0, frequency = 0, voltage = 0;
};

// At temperatures and rates of a low-discrepancy sequence.
void compare(const TrimmedGyro& gyro, double limit, int count, Errors& errors) {
  const StaticMap map(gyro, kCold, kHot, limit);
  const TrimmedGyro other = without_spurious_modes(gyro);
  for (int i = 0; i < count; ++i) {
    const double T =
        kCold + (kHot - kCold) * std::fmod(i * 0.7548776662466927, 1.0);
    const double rate =
        limit * (2 * std::fmod(i * 0.5698402909980532, 1.0) - 1);
    const BeamSignal exact = beam_signal(gyro, T, {.z = rate});
    const StaticMap::Signals s = map.at(T, rate);
    const auto grow = [](double& most, double error) {
      most = std::max(most, std::abs(error));
    };
    grow(errors.signal, std::abs(s.at_rate.demodulated - exact.demodulated));
    grow(errors.without,
         std::abs(s.without_spurious - beam_signal(other, T, {}).demodulated));
    grow(errors.frequency, s.at_rate.drive_frequency - exact.drive_frequency);
    grow(errors.voltage, s.at_rate.drive_voltage - exact.drive_voltage);
  }
}

void expect_small(const Errors& errors) {
  EXPECT_LT(errors.signal / kDegree, 1e-6);                    // [deg/s]
  EXPECT_LT(errors.without / kDegree, 1e-6);                   // [deg/s]
  EXPECT_LT(errors.frequency / (2 * std::numbers::pi), 1e-6);  // [Hz]
  EXPECT_LT(errors.voltage, 1e-7);                             // [V]
}

TEST(Verification, V66StaticMapOfAThousandUnits) {
  RandomStream stream(66, 0, 0, kDeviceDrawStream);
  Errors errors;
  for (int unit = 0; unit < 1000; ++unit) {
    DeviceParameters device = nominal_device();
    device.spurious_modes = drawn_modes(stream);
    compare(make_gyro(device), unit % 4 == 0 ? 120 * kDegree : 0, 200, errors);
  }
  expect_small(errors);
}

TEST(SpuriousMap, FollowsTheTallBumpOfUnitCUnderRates) {
  for (const double limit : {0.0, 2.0, 120.0, 1000.0}) {
    Errors errors;
    compare(kUnitC.gyro(), limit * kDegree, 4000, errors);
    expect_small(errors);
  }
}

TEST(SpuriousMap, WithoutModesBothAreOne) {
  const StaticMap map(make_gyro(nominal_device()), kCold, kHot, 0);
  const StaticMap::Signals s = map.at(280, 0);
  EXPECT_EQ(s.without_spurious, s.at_rest);
}

// Where the drive voltage stands at its limit both are scaled by their own.
TEST(SpuriousMap, BothUnitsStandAtTheLimitOfTheVoltage) {
  std::vector<std::string> overrides = kUnitC.overrides();
  overrides.emplace_back("drive.voltage_limit_V=0.86");
  const TrimmedGyro gyro = make_gyro(verification_device(overrides));
  const TrimmedGyro other = without_spurious_modes(gyro);
  const StaticMap map(gyro, kCold, kHot, 0);
  int limited = 0;
  for (double T = 295; T < 310; T += 0.37) {
    const BeamSignal exact = beam_signal(gyro, T, {});
    limited += !exact.amplitude_locked;
    const StaticMap::Signals s = map.at(T, 0);
    EXPECT_LT(std::abs(s.at_rest - exact.demodulated), 1e-6 * kDegree);
    EXPECT_LT(
        std::abs(s.without_spurious - beam_signal(other, T, {}).demodulated),
        1e-6 * kDegree);
  }
  EXPECT_GT(limited, 5);
}

TEST(SmoothModes, AreThoseOfTheExactParametersWithAnyTrim) {
  const TrimmedGyro gyro = kUnitB.gyro();
  const SmoothModes smooth(gyro, kCold - 20, kHot + 40);
  for (double T = kCold - 20; T < kHot + 40; T += 0.317) {
    const ModalParameters have = smooth.at(gyro, {T, T + 3});
    const ModalParameters want = modal_at(gyro, SpuriousTemperatures{T, T + 3});
    const double k = want.stiffness(0, 0);
    EXPECT_LT((have.stiffness - want.stiffness).cwiseAbs().maxCoeff(),
              1.1e-13 * k + 4e-16 * k);
    EXPECT_LT((have.damping - want.damping).cwiseAbs().maxCoeff(),
              1.1e-13 * std::sqrt(k * want.mass));
    for (std::size_t p = 0; p < kPatchCount; ++p)
      EXPECT_LT((have.coupling[p] - want.coupling[p]).norm(),
                1e-9 * want.coupling[p].norm());
    EXPECT_EQ(have.spurious[0].square, want.spurious[0].square);
    EXPECT_EQ(have.coriolis_mass, want.coriolis_mass);
  }
}

}  // namespace
}  // namespace beamgyro::internal
