// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_solution.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <numbers>

#include "sim/dynamics/gyro.h"
#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal::static_solution_test {
namespace {

constexpr double kT0 = kCalibrationTemperature;

struct NominalModes {
  TrimmedGyro gyro = make_gyro(verification_device());
  ModalParameters modal = modal_at(gyro, kT0);
  double feedthrough = gyro.device.readout.feedthrough;

  StaticSolution at(double rate) const {
    return static_solution(modal, gyro.loop, feedthrough, {.z = rate});
  }
};

TEST(StaticSolution, SatisfiesTheEquationsOfMotionAndTheLoopConditions) {
  const NominalModes modes;
  CaseMotion rotation{0.3, -0.2, 2, 0};
  const StaticSolution s = static_solution(modes.modal, modes.gyro.loop,
                                           modes.feedthrough, rotation);
  const Eigen::Vector2cd force = modes.modal.coupling[kDrive] * s.drive_voltage;
  const Eigen::Vector2cd left =
      dynamic_stiffness(modes.modal, s.drive_frequency, rotation) * s.amplitude;
  EXPECT_LT((left - force).norm(), 1e-9 * force.norm());
  const Complex feedback =
      modes.modal.coupling[kFeedback].transpose() * s.amplitude;
  EXPECT_NEAR(std::abs(feedback) / modes.gyro.loop.feedback_amplitude, 1,
              1e-12);
  EXPECT_NEAR(std::arg(-feedback),
              modes.gyro.loop.pll_phase - std::numbers::pi / 2, 1e-9);
}

TEST(Verification, V23SenseAmplitudePerRate) {
  const NominalModes modes;
  const double step = 0.1 * kDegree;
  const StaticSolution plus = modes.at(step), minus = modes.at(-step);
  const double per_deg_per_s = std::abs(
      (plus.amplitude(1) - minus.amplitude(1)) / (0.2) / plus.amplitude(0));
  const double expected = kDegree / std::hypot(447.292, 37.565);
  EXPECT_NEAR(expected, 3.888e-5, 5e-9);
  EXPECT_NEAR(per_deg_per_s / expected, 1, 1e-4);
}

TEST(Verification, V25TurningModesAndTransducersTogetherChangesNothing) {
  const NominalModes modes;
  ModalParameters turned = modes.modal;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(10 * kDegree).toRotationMatrix();
  turned.stiffness = R * turned.stiffness * R.transpose();
  turned.damping = R * turned.damping * R.transpose();
  for (Eigen::Vector2cd& coupling : turned.coupling) coupling = R * coupling;
  for (const double rate : {0.0, 1.0, -3.0}) {
    CaseMotion rotation{0.5, -0.4, rate, 0};
    // The cross rates turn with the modes.
    CaseMotion turned_rotation = rotation;
    const Eigen::Vector2d cross = R * Eigen::Vector2d(rotation.x, rotation.y);
    turned_rotation.x = cross(0);
    turned_rotation.y = cross(1);
    const StaticSolution a = static_solution(modes.modal, modes.gyro.loop,
                                             modes.feedthrough, rotation);
    const StaticSolution b = static_solution(
        turned, modes.gyro.loop, modes.feedthrough, turned_rotation);
    EXPECT_NEAR(std::abs(a.signal / b.signal - 1.0), 0, 1e-10);
    EXPECT_NEAR(a.drive_frequency / b.drive_frequency, 1, 1e-10);
    EXPECT_NEAR(a.drive_voltage / b.drive_voltage, 1, 1e-10);
  }
}

TEST(Verification, V26ScaleFactorNonlinearityAt300DegPerS) {
  const NominalModes modes;
  const double rate = 300 * kDegree;
  const auto slope = [&](double step) {
    return ((modes.at(step).signal - modes.at(-step).signal) /
            (2 * step * modes.gyro.rate_axis))
        .real();
  };
  EXPECT_NEAR((slope(rate) / slope(0.01) - 1) / -1.37e-4, 1, 0.02);
}

TEST(StaticSolution, AVoltageAtItsLimitScalesTheMotionAndSaysSo) {
  const NominalModes modes;
  const StaticSolution free = modes.at(0.5);
  DriveLoop weak = modes.gyro.loop;
  weak.voltage_limit = 0.5 * free.drive_voltage;
  const StaticSolution held =
      static_solution(modes.modal, weak, modes.feedthrough, {.z = 0.5});
  EXPECT_TRUE(free.amplitude_locked);
  EXPECT_FALSE(held.amplitude_locked);
  EXPECT_EQ(held.drive_frequency, free.drive_frequency);
  EXPECT_NEAR(std::abs(held.signal / free.signal), 0.5, 1e-12);
}

}  // namespace
}  // namespace beamgyro::internal::static_solution_test
