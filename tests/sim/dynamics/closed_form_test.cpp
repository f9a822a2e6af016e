// SPDX-License-Identifier: MIT
#include "tests/sim/dynamics/closed_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/device/nominal_device.h"
#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal::closed_form_test {
namespace {

constexpr double kT0 = kCalibrationTemperature;

// A gyro at T_0 with nothing that makes a zero-rate output, and with real
// couplings: the ceramic's loss turns the drive force by phi_D + phi_F against
// the Coriolis force, a third order term that (2.21) and (2.22) leave out.
struct IdealGyro {
  DeviceParameters device = verification_device();
  ProjectedBeam beam = project_beam(device);
  ModalParameters modal = modal_parameters(device, beam, kT0, 0);
  DriveLoop loop{};

  IdealGyro() {
    modal.stiffness(0, 1) = modal.stiffness(1, 0) = 0;
    modal.damping(0, 1) = modal.damping(1, 0) = 0;
    for (std::size_t p = 0; p < kPatchCount; ++p) {
      modal.coupling[p] = modal.coupling[p].real().cast<Complex>();
      modal.coupling[p](p < 2 ? 1 : 0) = 0;
    }
    loop = {std::abs(modal.coupling[kFeedback](0)) * device.drive.amplitude, 0,
            5};
  }

  // Exact B_0 - i Q_0 [rad/s] against (2.21), (2.22), to 0.5 %, and what a
  // board makes of it that is off in phase by `delta` against (2.23).
  void expect_closed_form(double feedthrough = 0, double delta = 0) const {
    const CaseMotion slow{.z = 1e-3};
    const StaticSolution at_rest =
        static_solution(modal, loop, feedthrough, {});
    const StaticSolution turning =
        static_solution(modal, loop, feedthrough, slow);
    const Complex exact =
        at_rest.signal / ((turning.signal - at_rest.signal) / slow.z);
    const ClosedForm expected =
        closed_form(modal, loop, feedthrough, at_rest.drive_frequency);
    const double size = std::hypot(expected.in_phase, expected.quadrature);
    EXPECT_GT(size, 1e-3);
    EXPECT_NEAR(exact.real(), expected.in_phase, 0.005 * size);
    EXPECT_NEAR(-exact.imag(), expected.quadrature, 0.005 * size);
    const double shown = (exact * std::polar(1.0, delta)).real();
    const double shown_expected = expected.in_phase * std::cos(delta) +
                                  expected.quadrature * std::sin(delta);
    const double shown_size =
        std::max(std::abs(shown_expected), size * std::sin(std::abs(delta)));
    EXPECT_NEAR(shown, shown_expected, 0.005 * shown_size + 1e-6 * size);
  }
};

TEST(Verification, V24StiffnessCouplingAlone) {
  IdealGyro gyro;
  gyro.modal.stiffness(0, 1) = gyro.modal.stiffness(1, 0) = 100;
  gyro.expect_closed_form();
}

TEST(Verification, V24DampingCouplingAlone) {
  IdealGyro gyro;
  gyro.modal.damping(0, 1) = gyro.modal.damping(1, 0) = 3e-4;
  gyro.expect_closed_form();
}

TEST(Verification, V24DriveMisalignmentAlone) {
  IdealGyro gyro;
  gyro.modal.coupling[kDrive](1) = 8e-3 * gyro.modal.coupling[kDrive](0);
  gyro.expect_closed_form();
}

TEST(Verification, V24ReadoutMisalignmentAlone) {
  IdealGyro gyro;
  gyro.modal.coupling[kReadout](0) = 5e-3 * gyro.modal.coupling[kReadout](1);
  gyro.expect_closed_form();
}

TEST(Verification, V24FeedthroughAlone) {
  IdealGyro gyro;
  gyro.expect_closed_form(0.5e-12);
}

TEST(Verification, V24ElectronicsPhaseShowsTheQuadrature) {
  IdealGyro gyro;
  gyro.modal.stiffness(0, 1) = gyro.modal.stiffness(1, 0) = 100;
  gyro.expect_closed_form(0, 1 * kDegree);
}

TEST(Verification, V42ClosedFormOverTemperature) {
  const TrimmedGyro gyro = make_gyro(verification_device());
  double largest = 0;
  for (double celsius = -40; celsius <= 60; celsius += 1) {
    const double T = celsius + kZeroCelsius;
    const double exact = zero_rate_output(gyro, T);
    largest = std::max(largest,
                       std::abs(exact - closed_form_output(gyro, T)) / kDegree);
  }
  EXPECT_LT(largest, 0.013);  // [deg/s]
}

}  // namespace
}  // namespace beamgyro::internal::closed_form_test
