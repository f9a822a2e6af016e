// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::static_map_test {
namespace {

class StaticMapAccuracy : public testing::TestWithParam<double> {};

TEST_P(StaticMapAccuracy, AgreesWithTheExactSolutionEverywhere) {
  constexpr double kCold = 228, kHot = 335;  // [K]
  const double limit = GetParam() * kDegree;
  const TrimmedGyro gyro = make_gyro(nominal_device());
  const StaticMap map(gyro, kCold, kHot, limit);
  double signal = 0, at_rest = 0, frequency = 0, voltage = 0;
  for (int i = 0; i < 4000; ++i) {  // a low-discrepancy sequence
    const double T =
        kCold + (kHot - kCold) * std::fmod(i * 0.7548776662466927, 1.0);
    const double rate =
        limit * (2 * std::fmod(i * 0.5698402909980532, 1.0) - 1);
    const BeamSignal exact = beam_signal(gyro, T, {.z = rate});
    const StaticMap::Signals s = map.at(T, rate);
    signal =
        std::max(signal, std::abs(s.at_rate.demodulated - exact.demodulated));
    at_rest = std::max(
        at_rest, std::abs(s.at_rest - beam_signal(gyro, T, {}).demodulated));
    frequency = std::max(
        frequency, std::abs(s.at_rate.drive_frequency - exact.drive_frequency));
    voltage = std::max(voltage,
                       std::abs(s.at_rate.drive_voltage - exact.drive_voltage));
  }
  EXPECT_LT(signal / kDegree, 1e-6);  // [deg/s]
  EXPECT_LT(at_rest / kDegree, 1e-6);
  EXPECT_LT(frequency / (2 * std::numbers::pi), 1e-6);  // [Hz]
  EXPECT_LT(voltage, 1e-7);                             // [V]
}

INSTANTIATE_TEST_SUITE_P(RateLimits, StaticMapAccuracy,
                         testing::Values(0.0, 2.0, 120.0, 1000.0));

TEST(StaticMap, ManySamplesAtATimeAreThoseOneByOne) {
  const double limit = 120 * kDegree;
  const StaticMap map(make_gyro(nominal_device()), 228, 335, limit);
  std::vector<double> T(1000), rate(1000);
  for (std::size_t k = 0; k < T.size(); ++k) {
    const auto x = static_cast<double>(k);
    T[k] = k % 7 == 0 ? 311.15 : 228 + 0.107 * x;  // also a border, and back
    rate[k] = k % 5 == 0 ? 0 : limit * std::sin(x);
  }
  std::vector<StaticMap::Signals> signals(T.size());
  map.sample(T, rate, {}, signals);
  for (std::size_t k = 0; k < T.size(); ++k) {
    const StaticMap::Signals one = map.at(T[k], rate[k]);
    EXPECT_EQ(signals[k].at_rate.demodulated, one.at_rate.demodulated) << k;
    EXPECT_EQ(signals[k].at_rate.drive_frequency, one.at_rate.drive_frequency);
    EXPECT_EQ(signals[k].at_rate.drive_voltage, one.at_rate.drive_voltage);
    EXPECT_EQ(signals[k].at_rest, one.at_rest) << k;
  }
}

// Halving towards a kink would take some twenty pieces for each.
TEST(StaticMap, PiecesEndAtTheKinksOfTheMaterials) {
  const TrimmedGyro gyro =
      make_gyro(nominal_device({"bond.glass_transition_degC=41.234",
                                "mount.glass_transition_degC=-23.456"}));
  EXPECT_LT(StaticMap(gyro, 228, 355, 0).pieces(), 30);
}

TEST(StaticMap, AVoltageLimitActsAsInTheExactSolution) {
  const TrimmedGyro gyro =
      make_gyro(nominal_device({"drive.voltage_limit_V=0.9"}));
  const StaticMap map(gyro, 233.15, 323.15, 0);
  int held = 0;
  for (double T = 233.15; T <= 323.15; T += 0.5) {
    const BeamSignal exact = beam_signal(gyro, T, {});
    const BeamSignal tabulated = map.at(T, 0).at_rate;
    EXPECT_EQ(tabulated.amplitude_locked, exact.amplitude_locked);
    EXPECT_NEAR(std::abs(tabulated.demodulated - exact.demodulated) / kDegree,
                0, 1e-6);
    held += exact.amplitude_locked ? 0 : 1;
  }
  EXPECT_GT(held, 20);
  EXPECT_LT(held, 160);
}

}  // namespace
}  // namespace beamgyro::internal::static_map_test
