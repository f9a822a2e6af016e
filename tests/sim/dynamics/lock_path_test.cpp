// SPDX-License-Identifier: MIT
// Which lock of a drive loop is the static solution, where strongly coupled
// modes have more than one.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "sim/dynamics/envelope.h"
#include "sim/dynamics/gyro.h"
#include "sim/dynamics/loop_noise.h"
#include "sim/dynamics/static_map.h"
#include "tests/linear_algebra/reference_algebra.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal::lock_path_test {
namespace {

constexpr double kHertz = 2 * std::numbers::pi;  // [rad/s]

std::vector<std::string> coupled(double side, double share, double angle) {
  return {"beam.side_difference=" + std::to_string(side),
          "mount.glassy_stiffness_share=" + std::to_string(share),
          "mount.axis_angle_deg=" + std::to_string(angle)};
}

TrimmedGyro strongly_coupled() {
  return make_gyro(nominal_device(coupled(-0.003, 0.01, 20)));
}

struct Shown {
  double frequency, bias;  // [Hz], [deg/s]
};

// Board and beam at one temperature.
Shown shown(const TrimmedGyro& gyro, double celsius) {
  const double T = celsius + kZeroCelsius;
  const BeamSignal signal = beam_signal(gyro, T, {});
  return {signal.drive_frequency / kHertz,
          electronics_at(gyro, T).output(signal.demodulated).rate / kDegree};
}

// Frequencies and bias that an envelope run of this device settles to.
TEST(Verification, V57StronglyCoupledModesLockWhereTheEnvelopeDoes) {
  const TrimmedGyro gyro = strongly_coupled();
  const Shown cold = shown(gyro, -40);
  EXPECT_NEAR(cold.frequency, 9145.09, 0.01);
  EXPECT_NEAR(cold.bias / -1578, 1, 0.005);
  EXPECT_NEAR(shown(gyro, -30).frequency, 9143.59, 0.01);
}

// Growth rate of the fastest growing disturbance of beam and loops, or a little
// more, from the largest that any disturbance can be after a time [1/s].
double growth(const TrimmedGyro& gyro, double celsius) {
  const double T = celsius + kZeroCelsius;
  EnvelopeOde ode(gyro, drive_heating(gyro));
  const Eigen::VectorXd y = settled_state(gyro, ode, {}, T, T);
  Eigen::MatrixXd slope(y.size(), y.size());
  ode.jacobian({.motion = {}, .surroundings = {T}, .powered = true}, y, slope);
  constexpr double kAfter = 3;  // [s]
  const Eigen::MatrixXd slopes = slope.topLeftCorner(kReadout1, kReadout1);
  return std::log(reference::exponential(slopes * kAfter).norm()) / kAfter;
}

TEST(LockPath, LeadsToLocksThatTheLoopsHold) {
  const TrimmedGyro gyro = strongly_coupled();
  for (double celsius = -40; celsius <= 60; celsius += 5)
    EXPECT_LT(growth(gyro, celsius), -5) << celsius;  // [1/s]
}

TEST(LockPath, IsContinuous) {
  for (const std::vector<std::string>& keys :
       {coupled(-0.003, 0.01, 20), coupled(-0.0004, 0.0258, 33.9),
        coupled(-0.0015, 0.0226, 38.3)}) {
    const TrimmedGyro gyro = make_gyro(nominal_device(keys));
    double before = shown(gyro, 25).frequency;
    for (double celsius = 25; celsius >= -40; celsius -= 0.25) {
      const double frequency = shown(gyro, celsius).frequency;
      // A glass transition moves the modes by 3 Hz/K; locks are 10 Hz apart.
      EXPECT_NEAR(frequency, before, 1.5) << celsius;
      before = frequency;
    }
  }
}

StaticSolution lowest_voltage(const TrimmedGyro& gyro, double celsius) {
  return static_solution(modal_at(gyro, celsius + kZeroCelsius), gyro.loop,
                         gyro.device.readout.feedthrough, {});
}

// Modes come near each other and part again on the way from 25 degC: what was
// the drive mode there is driven worse than the other one here.
TEST(LockPath, MayNeedMoreVoltageThanTheOtherLock) {
  const TrimmedGyro gyro =
      make_gyro(nominal_device(coupled(-0.0004, 0.0258, 33.9)));
  const StaticSolution other = lowest_voltage(gyro, -40);
  EXPECT_FALSE(other.only_lock);
  const StaticSolution continued =
      static_solution(gyro, modal_at(gyro, -40 + kZeroCelsius), {});
  EXPECT_LT(continued.drive_frequency, other.drive_frequency - 50 * kHertz);
  EXPECT_GT(continued.drive_voltage, 1.5 * other.drive_voltage);
}

// The lock of 25 degC and the unstable one meet above -17 degC.
TEST(LockPath, WhereItEndsTheLockOfTheLowestVoltageIsTaken) {
  const TrimmedGyro gyro =
      make_gyro(nominal_device(coupled(-0.00032, 0.0367, 33.5)));
  LockPath path;
  EXPECT_GT(path.at(gyro, 25 + kZeroCelsius), 0);
  EXPECT_EQ(path.at(gyro, -30 + kZeroCelsius), 0);
  const StaticSolution s =
      static_solution(gyro, modal_at(gyro, -30 + kZeroCelsius), {});
  EXPECT_FALSE(s.only_lock);
  EXPECT_EQ(s.drive_frequency, lowest_voltage(gyro, -30).drive_frequency);
}

// Stable locks by a look at every frequency.
std::vector<double> locks_found(const TrimmedGyro& gyro,
                                const ModalParameters& modal) {
  const auto lock = [&](double omega) -> Complex {
    const Eigen::Matrix2cd compliance =
        reference::inverse(dynamic_stiffness(modal, omega, {}));
    const auto charge = [&](Patch patch, const Eigen::Vector2cd& u) -> Complex {
      return modal.coupling[patch].transpose() * u;
    };
    Eigen::Vector2cd u = compliance * modal.coupling[kDrive];
    if (gyro.loop.mode == ReadoutMode::kForceRebalance) {
      const Eigen::Vector2cd b = compliance * modal.coupling[kDamping];
      u -= (charge(kReadout, u) + gyro.device.readout.feedthrough) /
           charge(kReadout, b) * b;
    }
    return -std::polar(1.0, std::numbers::pi / 2 - gyro.loop.pll_phase) *
           charge(kFeedback, u);
  };
  constexpr double kStep = 0.02 * kHertz;
  const double own = std::sqrt(modal.stiffness(0, 0) / modal.mass);
  std::vector<double> found;
  Complex before = lock(own - 300 * kHertz);
  for (double omega = own - 300 * kHertz; omega < own + 300 * kHertz;
       omega += kStep) {
    const Complex after = lock(omega + kStep);
    if (before.imag() > 0 && after.imag() <= 0 && after.real() > 0)
      found.push_back(omega +
                      kStep * before.imag() / (before.imag() - after.imag()));
    before = after;
  }
  return found;
}

class AllLocks : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Modes, AllLocks,
                         testing::Values("open_loop", "force_rebalance"));

// The lock is one of those found, and it is the only one where one is found.
TEST_P(AllLocks, AreKnown) {
  int several = 0;
  for (const auto& [side, share, angle] :
       {std::array{-0.0085, 6e-4, 2.0}, std::array{-0.003, 0.01, 20.0},
        std::array{0.004, 0.008, 30.0}, std::array{-0.0004, 0.0258, 33.9},
        std::array{-0.006, 0.02, -40.0}}) {
    std::vector<std::string> keys = coupled(side, share, angle);
    keys.push_back("readout.mode=\"" + GetParam() + "\"");
    const TrimmedGyro gyro = make_gyro(nominal_device(keys));
    for (double celsius = -40; celsius <= 60; celsius += 5) {
      const ModalParameters modal = modal_at(gyro, celsius + kZeroCelsius);
      const std::vector<double> locks = locks_found(gyro, modal);
      const StaticSolution s = static_solution(gyro, modal, {});
      EXPECT_EQ(s.only_lock, locks.size() == 1)
          << side << ' ' << share << ' ' << angle << ' ' << celsius;
      // Between two points of the scan the phase is straight to 1e-4 of them.
      EXPECT_TRUE(std::any_of(locks.begin(), locks.end(),
                              [&](double omega) {
                                return std::abs(omega - s.drive_frequency) <
                                       1e-4 * kHertz;
                              }))
          << side << ' ' << share << ' ' << angle << ' ' << celsius;
      several += locks.size() > 1;
    }
  }
  if (GetParam() == "open_loop") {
    EXPECT_GE(several, 5);
  }
}

TEST(StaticMap, OfStronglyCoupledModesAgreesWithTheExactSolution) {
  const TrimmedGyro gyro = strongly_coupled();
  const StaticMap map(gyro, 233.15, 333.15, 10 * kDegree);
  for (int i = 0; i < 200; ++i) {
    const double T = 233.15 + 0.5 * i;
    const CaseMotion motion{.z = 9 * kDegree * std::cos(i)};
    const Complex exact = beam_signal(gyro, T, motion).demodulated;
    EXPECT_LT(std::abs(map.at(T, motion.z).at_rate.demodulated - exact),
              1e-5 * kDegree)
        << T;
  }
}

}  // namespace
}  // namespace beamgyro::internal::lock_path_test
