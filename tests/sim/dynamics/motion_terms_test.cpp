// SPDX-License-Identifier: MIT
// What the motion of the case does besides the rate about the input axis.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/dynamics/gyro.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal::motion_terms_test {
namespace {

constexpr double kT0 = kCalibrationTemperature;

// Change of rate and quadrature by a motion.
Output change_by(const TrimmedGyro& gyro, const CaseMotion& motion) {
  const Complex change = beam_signal(gyro, kT0, motion).demodulated -
                         beam_signal(gyro, kT0, {}).demodulated;
  return {change.real(), -change.imag()};
}

double drive_frequency(const TrimmedGyro& gyro) {
  return beam_signal(gyro, kT0, {}).drive_frequency;
}

TEST(Verification, V29EulerForceShowsAsQuadrature) {
  const TrimmedGyro gyro = make_gyro(verification_device());
  const CaseMotion motion{.z_acceleration = 1000};  // [rad/s2]
  const double expected = 1000 / (2 * drive_frequency(gyro));
  EXPECT_NEAR(expected, 8.76e-3, 0.01e-3);
  EXPECT_NEAR(change_by(gyro, motion).quadrature / expected, 1, 0.02);
}

TEST(Verification, V30CrossAxisRatesShowAsQuadratureOnly) {
  const TrimmedGyro gyro = make_gyro(verification_device());
  const double expected = 5.0 * 5.0 / (2 * drive_frequency(gyro));
  EXPECT_NEAR(expected, 2.2e-4, 0.01e-4);
  // Equal rates shift both modes alike: nothing but the product is left.
  for (const double sign : {1.0, -1.0}) {
    const Output change = change_by(gyro, {.x = 5, .y = sign * 5});
    EXPECT_NEAR(change.quadrature / expected, sign, 0.05);
    EXPECT_NEAR(change.rate / expected, 0, 0.05);
  }
}

TEST(Verification, V31RebalanceNullsTheChargeUnderAnyMotion) {
  const TrimmedGyro open = make_gyro(nominal_device());
  const TrimmedGyro closed =
      make_gyro(nominal_device({"readout.mode=\"force_rebalance\""}));
  const double feedthrough = closed.device.readout.feedthrough;
  ASSERT_GT(feedthrough, 0);
  const auto charge = [&](const TrimmedGyro& gyro, const CaseMotion& motion) {
    const ModalParameters modal = modal_at(gyro, kT0);
    const StaticSolution s =
        static_solution(modal, gyro.loop, feedthrough, motion);
    const Complex readout = modal.coupling[kReadout].transpose() * s.amplitude;
    return std::abs(readout + feedthrough * s.drive_voltage);
  };
  const CaseMotion motions[] = {
      {}, {.z = 2}, {.x = 5, .y = -3, .z = 1, .z_acceleration = 10}};
  for (const CaseMotion& motion : motions)
    EXPECT_LT(charge(closed, motion), 1e-9 * charge(open, motion));
}

TEST(CentrifugalForce, SoftensTheModeAcrossTheAxisOfRotation) {
  const TrimmedGyro gyro = make_gyro(verification_device());
  const auto solved = [&](const CaseMotion& motion) {
    return beam_signal(gyro, kT0, motion);
  };
  const auto scale = [&](CaseMotion motion) {
    motion.z = 1;
    const Complex up = solved(motion).demodulated;
    motion.z = -1;
    return std::abs(up - solved(motion).demodulated) / 2;
  };
  constexpr double kFast = 300;  // [rad/s]
  const double w = drive_frequency(gyro);
  const double shift = kFast * kFast / (2 * w);  // [rad/s]

  // About y: the drive mode, whose frequency the loop follows.
  EXPECT_NEAR((w - solved({.y = kFast}).drive_frequency) / shift, 1, 0.01);
  EXPECT_NEAR((w - solved({.x = kFast}).drive_frequency) / shift, 0, 0.01);

  // About x: the sense mode, which comes nearer: SF ~ 1/D (2.20).
  const ModalParameters modal = modal_at(gyro, kT0);
  const double split = (modal.stiffness(1, 1) / modal.mass - w * w) / (2 * w);
  const double rate = modal.damping(1, 1) / (2 * modal.mass);  // 1/tau_y
  const double expected =
      std::hypot(split, rate) / std::hypot(split - shift, rate) - 1;
  EXPECT_NEAR((scale({.x = kFast}) / scale({}) - 1) / expected, 1, 0.05);
}

TEST(InPhaseRate, IsLinearInAccelerationWithARectifiedPart) {
  const TrimmedGyro gyro = make_gyro(nominal_device());
  constexpr double g = 9.80665;
  const MountParameters& mount = gyro.device.mount;
  EXPECT_NEAR(in_phase_rate(mount, {g, 0, 0}) / kDegree, 0.02 + 0.002, 1e-12);
  EXPECT_NEAR(in_phase_rate(mount, {0, -g, 0}) / kDegree, -0.02 + 0.002, 1e-12);
  EXPECT_NEAR(in_phase_rate(mount, {0, 0, 2 * g}) / kDegree, 0.01 + 0.008,
              1e-12);
}

TEST(InPhaseRate, ShowsInTheOutputAsARateDoes) {
  const TrimmedGyro gyro = make_gyro(nominal_device());
  CaseMotion accelerated, turning;
  accelerated.in_phase = turning.z = 0.1 * kDegree;
  EXPECT_NEAR(change_by(gyro, accelerated).rate / change_by(gyro, turning).rate,
              1, 0.01);
}

}  // namespace
}  // namespace beamgyro::internal::motion_terms_test
