// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/dynamics/modal_table.h"
#include "sim/dynamics/static_map.h"
#include "sim/numerics/simulation_failure.h"
#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::memory_map_test {
namespace {

// The nominal unit with every memory effect at its default constants.
TrimmedGyro lifelike(std::vector<std::string> more = {}) {
  more.insert(more.end(), {"memory.relaxation={}", "memory.hysteresis={}",
                           "memory.ageing={}"});
  return make_gyro(nominal_device(more));
}

BeamSignal exact(const TrimmedGyro& gyro, double T, double rate,
                 const MemoryState& memory) {
  return beam_signal(
      gyro,
      modal_parameters(gyro.device, gyro.beam, T, gyro.stiffness_trim, memory),
      {.z = rate});
}

// T_f - T_f,ref of a bond that has been cooled slowly, or is being heated: the
// offset ends within 8 K above T_g.
MemoryRange slow_bounds(double low, double) {
  const double above = std::clamp(low - 311.15, 0.0, 8.0);
  const double share = 1 - above / 8;
  return {{-6 * share - 1e-3, -1, -0.3}, {1 * share, 1, 1.2}};
}

class MemoryMap : public testing::TestWithParam<double> {};

TEST_P(MemoryMap, AgreesWithTheExactSolutionEverywhere) {
  constexpr double kCold = 233, kHot = 328;  // [K]
  const double limit = GetParam() * kDegree;
  const TrimmedGyro gyro = lifelike();
  const StaticMap map(gyro, kCold, kHot, limit, slow_bounds);
  double signal = 0, frequency = 0, voltage = 0, effect = 0;
  for (int i = 0; i < 2000; ++i) {  // a low-discrepancy sequence
    const auto place = [i](double step) { return std::fmod(i * step, 1.0); };
    const double T = kCold + (kHot - kCold) * place(0.8566748838545029);
    const double rate = limit * (2 * place(0.7338918566271260) - 1);
    const auto [low, high] = slow_bounds(T, T);
    const MemoryState state = {
        std::lerp(low.glass_offset, high.glass_offset,
                  place(0.6287067210378087)),
        std::lerp(low.hysteresis, high.hysteresis, place(0.5385972572236101)),
        std::lerp(low.decades, high.decades, place(0.4614018275640093))};
    const BeamSignal want = exact(gyro, T, rate, state);
    const StaticMap::Signals have = map.at(T, rate, state);
    signal =
        std::max(signal, std::abs(have.at_rate.demodulated - want.demodulated));
    signal = std::max(
        signal, std::abs(have.at_rest - exact(gyro, T, 0, state).demodulated));
    frequency = std::max(frequency, std::abs(have.at_rate.drive_frequency -
                                             want.drive_frequency));
    voltage = std::max(
        voltage, std::abs(have.at_rate.drive_voltage - want.drive_voltage));
    effect = std::max(effect, std::abs(want.demodulated -
                                       exact(gyro, T, rate, {}).demodulated));
  }
  EXPECT_GT(effect / kDegree, 0.3);
  EXPECT_LT(signal / kDegree, 1e-5);                    // [deg/s]
  EXPECT_LT(frequency / (2 * std::numbers::pi), 1e-5);  // [Hz]
  EXPECT_LT(voltage, 1e-6);                             // [V]
}

INSTANTIATE_TEST_SUITE_P(RateLimits, MemoryMap, testing::Values(0.0, 120.0));

TEST(MemoryMap, ARangeOfTheGlassThatItCannotResolveIsRefused) {
  // T_f far above T, where tau_alpha changes by many decades along the axis.
  const TrimmedGyro gyro =
      make_gyro(nominal_device({"memory.relaxation.nonlinearity=0.0"}));
  const auto wide = [](double, double) {
    return MemoryRange{{-40, -1, 0}, {30, 1, 1}};
  };
  EXPECT_TRUE(holds(rejection<SimulationFailure>(
                        [&] { StaticMap(gyro, 298.15, 298.25, 0, wide); }),
                    "memory states of the beam at 2"));
}

TEST(V48Memory, WithoutAnEffectNothingChangesToTheLastBit) {
  // The states act on a device without [memory] as little as on one that has
  // it in its reference state.
  const TrimmedGyro plain = make_gyro(nominal_device()), gyro = lifelike();
  EXPECT_EQ(plain.stiffness_trim, gyro.stiffness_trim);
  EXPECT_EQ(plain.offset, gyro.offset);
  for (const double celsius : {-60.0, -40.0, 10.0, 38.0, 41.0, 90.0}) {
    const double T = celsius + kZeroCelsius;
    const BeamSignal want = beam_signal(plain, T, {});
    EXPECT_EQ(exact(plain, T, 0, {-3, 0.5, 1}).demodulated, want.demodulated);
    EXPECT_EQ(exact(gyro, T, 0, {}).demodulated, want.demodulated);
  }
}

TEST(Memory, EffectsHaveTheSizesOfTheSpecification) {
  const TrimmedGyro gyro = lifelike();
  const auto change = [&](const MemoryState& state) {
    const double T = 298.15;
    return (exact(gyro, T, 0, state).demodulated -
            exact(gyro, T, 0, {}).demodulated)
               .real() /
           kDegree;
  };
  // G_U by -2 % is -0.115 deg/s and -0.488 Hz of the drive frequency.
  EXPECT_NEAR(change({10, 0, 0}), -0.115, 0.005);
  EXPECT_NEAR((exact(gyro, 298.15, 0, {10, 0, 0}).drive_frequency -
               exact(gyro, 298.15, 0, {}).drive_frequency) /
                  (2 * std::numbers::pi),
              -0.488, 0.01);
  // Im K_xy of 5e-8 of K_0 is 0.08 deg/s; the quadrature that comes with c_k
  // and the turn of the axis are small beside it at 25 degC.
  EXPECT_NEAR(std::abs(change({0, 1, 0})), 0.08, 0.03);
}

TEST(V58Memory, LossesStayPositiveOverAllHistories) {
  const TrimmedGyro gyro =
      lifelike();  // make_gyro() refuses a unit that does not
  for (double T = 173.15; T <= 423.15; T += 10) {
    for (const double glass : {-40.0, -7.0, 0.0, 9.0}) {
      for (const double hysteresis : {-1.0, -0.3, 1.0}) {
        for (const double decades : {-0.9, 0.0, 5.0}) {
          const Eigen::Matrix2d damping =
              modal_parameters(gyro.device, gyro.beam, T, gyro.stiffness_trim,
                               {glass, hysteresis, decades})
                  .damping;
          EXPECT_GT(damping(0, 0), 0);
          EXPECT_GT(damping(0, 0) * damping(1, 1),
                    damping(0, 1) * damping(1, 0));
        }
      }
    }
  }
}

TEST(V58Memory, AHysteresisThatCreatesEnergyIsRefused) {
  // Without the losses of ceramic, bond and metal a cross term of 1e-4 is more
  // than those that remain.
  const std::string message = rejection<SimulationFailure>([] {
    make_gyro(nominal_device({"memory.hysteresis.loss=-1e-4",
                              "patches.mechanical_loss_factor=1e-5",
                              "bond.beta_step_Pa=0", "bond.alpha_step_Pa=0",
                              "beam.loss_factor=1e-6"}));
  });
  EXPECT_TRUE(holds(message, "[memory] creates energy"));
  EXPECT_TRUE(holds(message, "hysteresis at -1.00"));
}

}  // namespace
}  // namespace beamgyro::internal::memory_map_test
