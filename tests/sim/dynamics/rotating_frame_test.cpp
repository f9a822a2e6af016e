// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "sim/dynamics/static_solution.h"
#include "sim/numerics/ode.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::rotating_frame_test {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector4d;

constexpr double kOmega = 2 * std::numbers::pi;  // one cycle a second

// Both modes in the moving case, y = (x, y, x', y').
struct Modes {
  Matrix2d stiffness = kOmega * kOmega * Matrix2d::Identity();
  Matrix2d damping = Matrix2d::Zero();
  double gain = 1;
  CaseMotion motion;
  std::function<Vector2d(double)> force = [](double) -> Vector2d {
    return Vector2d::Zero();
  };

  ExplicitRk integrator(const Vector4d& start, double tolerance = 1e-12) const {
    const ModeForces forces = mode_forces(stiffness, damping, gain, motion);
    const Matrix2d position = forces.position + euler_force(gain, motion);
    ExplicitRkOptions options;
    options.relative_tolerance = tolerance;
    options.absolute_tolerance.setConstant(tolerance);
    return ExplicitRk(
        [forces, position, f = force](double t, const auto& y, auto dydt) {
          dydt.template head<2>() = y.template tail<2>();
          dydt.template tail<2>() = f(t) -
                                    forces.velocity * y.template tail<2>() -
                                    position * y.template head<2>();
        },
        0, start, options);
  }
};

// Angle of the long axis of the orbit, modulo pi, in the frame of the case:
// of the ellipse with amplitudes X, Y of e^{i w t}, where w is `frequency`.
double orbit_angle(const Vector4d& y, double frequency) {
  const std::complex<double> X(y(0), -y(2) / frequency);
  const std::complex<double> Y(y(1), -y(3) / frequency);
  const double cross = 2 * std::real(X * std::conj(Y));
  return 0.5 * std::atan2(cross, std::norm(X) - std::norm(Y));
}

// Position and velocity as seen from a frame that stands turned by -`angle` in
// the case and turns at -`rate`.
Vector4d turned_back(const Vector4d& y, double angle, double rate) {
  const Matrix2d back{{std::cos(angle), -std::sin(angle)},
                      {std::sin(angle), std::cos(angle)}};
  Vector4d seen;
  seen << back * y.head<2>(),
      back * Vector2d(y(2) - rate * y(1), y(3) + rate * y(0));
  return seen;
}

TEST(Verification, V14CoriolisForceDoesNoWork) {
  Modes modes;
  modes.stiffness << 40, 0.3, 0.3, 41;
  modes.motion.z = 0.2;
  const auto energy = [&](const Vector4d& y) {
    const Matrix2d K =
        mode_forces(modes.stiffness, modes.damping, 1, modes.motion).position;
    const Vector2d q = y.head<2>();
    return 0.5 * y.tail<2>().squaredNorm() + 0.5 * q.dot(K * q);
  };
  const Vector4d start(1, 0, 0, 0.3);
  ExplicitRk rk = modes.integrator(start, 1e-11);
  double largest = 0;
  for (int cycle = 10; cycle <= 1000; cycle += 10) {
    const Vector4d y = rk.advance_to(cycle);
    largest = std::max(largest, std::abs(energy(y) / energy(start) - 1));
  }
  EXPECT_LT(largest, 1e-8);
}

TEST(Verification, V15FoucaultPlaneStaysInSpace) {
  Modes modes;
  modes.motion.z = 0.05;
  const double t = 10 / modes.motion.z;  // ten radians
  // At rest in space means turning backwards in the case.
  const Vector4d y = modes.integrator({1, 0, 0, -modes.motion.z}).advance_to(t);
  const Vector4d in_space = turned_back(y, 10, modes.motion.z);
  EXPECT_NEAR(in_space(0), std::cos(kOmega * t), 1e-7);
  EXPECT_NEAR(in_space(2), -kOmega * std::sin(kOmega * t), 1e-7 * kOmega);
  EXPECT_NEAR(in_space(1), 0, 1e-7);
  EXPECT_NEAR(orbit_angle(in_space, kOmega), 0, 1e-7);
}

TEST(Verification, V16AngularGainBelowOnePrecessesByThatMuch) {
  Modes modes;
  modes.gain = 0.977;
  modes.motion.z = 0.05;
  const double rate = modes.motion.z, g = modes.gain;
  const double t = 200;
  // x + i y = e^{-i g Omega t} cos(w t) is an exact solution.
  const double w =
      std::sqrt(kOmega * kOmega - g * rate * rate + g * g * rate * rate);
  const Vector4d y = modes.integrator({1, 0, 0, -g * rate}).advance_to(t);
  const double turned = g * rate * t;
  const Vector4d back = turned_back(y, turned, g * rate);
  EXPECT_NEAR(orbit_angle(back, w), 0, 1e-8 * turned);
  const double phase = std::arg(std::complex<double>(back(0), -back(2) / w) *
                                std::polar(1.0, -w * t));
  EXPECT_NEAR(phase, 0, 1e-8 * w * t);
  EXPECT_NEAR(std::hypot(back(0), back(2) / w), 1, 1e-8);
}

TEST(Verification, V17FreeDecay) {
  constexpr double kQ = 50, kTau = 2 * kQ / kOmega;
  Modes modes;
  modes.damping = kOmega / kQ * Matrix2d::Identity();
  const double w = kOmega * std::sqrt(1 - 1 / (4 * kQ * kQ));
  ExplicitRk rk = modes.integrator({1, 0, -1 / kTau, 0});
  for (const double t : {1.3, 7.0, 40.0}) {
    EXPECT_NEAR(rk.advance_to(t)(0), std::exp(-t / kTau) * std::cos(w * t),
                1e-8);
  }
}

TEST(Verification, V18BeatOfACoupledPair) {
  constexpr double kSplit = 0.004 * kOmega, kCoupling = 0.002 * kOmega;
  Modes modes;
  const double x = kOmega - kSplit / 2, y = kOmega + kSplit / 2;
  modes.stiffness << x * x, 2 * kOmega * kCoupling, 2 * kOmega * kCoupling,
      y * y;
  ExplicitRk rk = modes.integrator({1, 0, 0, 0});
  // The other mode's energy is first zero again after one beat.
  const double beat = 2 * std::numbers::pi / std::hypot(kSplit, 2 * kCoupling);
  const auto other = [&](double t) {
    const Vector4d s = rk.advance_to(t);
    return kOmega * kOmega * s(1) * s(1) + s(3) * s(3);
  };
  double least = 1e9, when = 0;
  for (double t = 0.9 * beat; t < 1.1 * beat; t += 1e-4 * beat) {
    const double energy = other(t);
    if (energy < least) least = energy, when = t;
  }
  EXPECT_NEAR(when / beat, 1, 1e-3);
}

TEST(Verification, V19DrivenVibrationIsTheAlgebraicSolution) {
  Modes modes;
  modes.stiffness << 39.2, 0.05, 0.05, 40.1;
  modes.damping << 0.12, 0.01, 0.01, 0.15;
  modes.gain = 0.98;
  modes.motion = {0.3, -0.2, 0.02, 0, 0.004};
  constexpr double kDrive = 6.3;
  modes.force = [](double t) -> Vector2d {
    return {std::cos(kDrive * t), 0.2 * std::sin(kDrive * t)};
  };
  const auto [position, velocity] =
      mode_forces(modes.stiffness, modes.damping, modes.gain, modes.motion);
  const std::complex<double> i(0, 1);
  Eigen::Matrix2cd S = position.cast<std::complex<double>>() +
                       i * kDrive * velocity.cast<std::complex<double>>();
  S.diagonal().array() -= kDrive * kDrive;
  const Eigen::Vector2cd u =
      reference::solution(S, Eigen::Vector2cd(1.0, -0.2 * i));
  ExplicitRk rk = modes.integrator(Vector4d::Zero());
  for (const double t : {400.0, 400.3, 401.7}) {
    const Vector4d y = rk.advance_to(t);
    const Eigen::Vector2cd now = u * std::exp(i * kDrive * t);
    EXPECT_NEAR(y(0), now(0).real(), 1e-6 * u.norm());
    EXPECT_NEAR(y(1), now(1).real(), 1e-6 * u.norm());
  }
}

}  // namespace
}  // namespace beamgyro::internal::rotating_frame_test
