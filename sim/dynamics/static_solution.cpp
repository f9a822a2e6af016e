// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_solution.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamgyro {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Vector2cd;

// The unconjugated product Theta^T u.
Complex charge_of(const Vector2cd& coupling, const Vector2cd& u) {
  return coupling.transpose() * u;
}

ModeForces forces_of(const ModalParameters& modal, const CaseMotion& motion) {
  return mode_forces(modal.stiffness / modal.mass, modal.damping / modal.mass,
                     modal.coriolis_mass / modal.mass, motion);
}

// Response per volt of the drive and its derivative in omega.
struct Response {
  Vector2cd u, du;      // [m/V]
  Complex balance = 0;  // V_B per volt of the drive
  Complex lock;         // -Theta_F^T u e^{i(90 deg - phi_pll)}, real: locked
  Complex lock_slope;   // d lock / d omega
};

// Adds to the response to the drive that of the V_B which nulls the charge.
void rebalance(const ModalParameters& modal, double feedthrough,
               const Matrix2cd& inverse, const Matrix2cd& slope, Response& r) {
  const Vector2cd& readout = modal.coupling[kReadout];
  const Vector2cd b = inverse * modal.coupling[kDamping];
  const Vector2cd db = -inverse * (slope * b);
  const Complex gain = charge_of(readout, b);
  r.balance = -(charge_of(readout, r.u) + feedthrough) / gain;
  const Complex d_balance =
      -(charge_of(readout, r.du) + r.balance * charge_of(readout, db)) / gain;
  r.u += r.balance * b;
  r.du += r.balance * db + d_balance * b;
}

Response response(const ModalParameters& modal, double omega,
                  const DriveLoop& loop, double feedthrough,
                  const CaseMotion& motion) {
  const Matrix2cd inverse = dynamic_stiffness(modal, omega, motion).inverse();
  const Matrix2cd slope =
      modal.mass *
      (Complex(0, 1) * forces_of(modal, motion).velocity.cast<Complex>() -
       2 * omega * Matrix2cd::Identity());
  Response r;
  r.u = inverse * modal.coupling[kDrive];
  r.du = -inverse * (slope * r.u);
  if (loop.mode == ReadoutMode::kForceRebalance) {
    rebalance(modal, feedthrough, inverse, slope, r);
  }
  const Complex turn = std::polar(1.0, std::numbers::pi / 2 - loop.pll_phase);
  r.lock = -turn * charge_of(modal.coupling[kFeedback], r.u);
  r.lock_slope = -turn * charge_of(modal.coupling[kFeedback], r.du);
  return r;
}

}  // namespace

Matrix2cd dynamic_stiffness(const ModalParameters& modal, double omega,
                            const CaseMotion& motion) {
  const ModeForces forces = forces_of(modal, motion);
  const Matrix2d real = forces.position +
                        euler_force(modal.coriolis_mass / modal.mass, motion) -
                        omega * omega * Matrix2d::Identity();
  return modal.mass * (real.cast<Complex>() +
                       Complex(0, omega) * forces.velocity.cast<Complex>());
}

StaticSolution static_solution(const ModalParameters& modal,
                               const DriveLoop& loop, double feedthrough,
                               const CaseMotion& motion) {
  constexpr int kMaxIterations = 60;
  constexpr double kTolerance = 1e-13;  // of the frequency, relative
  double omega = std::sqrt(modal.stiffness(0, 0) / modal.mass);
  const double half_width = modal.damping(0, 0) / (2 * modal.mass);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Response r = response(modal, omega, loop, feedthrough, motion);
    const double slope = (r.lock_slope / r.lock).imag();
    const double step =
        std::clamp(-std::arg(r.lock) / slope, -half_width, half_width);
    omega += step;
    if (std::abs(step) > kTolerance * omega) continue;

    StaticSolution solution;
    const double wanted = loop.feedback_amplitude /
                          std::abs(charge_of(modal.coupling[kFeedback], r.u));
    solution.drive_frequency = omega;
    solution.amplitude_locked = wanted <= loop.voltage_limit;
    solution.drive_voltage = std::min(wanted, loop.voltage_limit);
    solution.amplitude = r.u * solution.drive_voltage;
    solution.signal =
        loop.mode == ReadoutMode::kForceRebalance
            ? r.balance * solution.drive_voltage
            : charge_of(modal.coupling[kReadout], solution.amplitude) +
                  feedthrough * solution.drive_voltage;
    return solution;
  }
  throw std::runtime_error(
      fmt::format("drive loop: no frequency near {:.2f} Hz satisfies the phase "
                  "condition; the loop cannot lock",
                  omega / (2 * std::numbers::pi)));
}

}  // namespace beamgyro
