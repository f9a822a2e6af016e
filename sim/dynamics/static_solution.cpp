// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/dynamics/complex_form.h"

namespace beamgyro {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Vector2cd;

// 1/z of a z whose square is far from both ends of a double's range; the
// library's division looks after those too and takes several times as long.
Complex reciprocal(Complex z) { return std::conj(z) / std::norm(z); }

// Position takes the Euler force in.
ModeForces forces_of(const ModalParameters& modal, const CaseMotion& motion) {
  const double gain = modal.coriolis_mass / modal.mass;
  ModeForces forces = mode_forces(modal.stiffness / modal.mass,
                                  modal.damping / modal.mass, gain, motion);
  forces.position += euler_force(gain, motion);
  return forces;
}

Matrix2cd stiffness_at(double omega, double mass, const ModeForces& forces) {
  Matrix2cd S;
  S.real() = mass * (forces.position - omega * omega * Matrix2d::Identity());
  S.imag() = mass * omega * forces.velocity;
  return S;
}

// What Newton's method solves again and again.
struct Problem {
  const ModalParameters& modal;
  ModeForces forces;
  Complex turn;  // -e^{i(90 deg - phi_pll)}
  bool rebalance;
  double feedthrough;
};

// Response per volt of the drive and its derivative in omega.
struct Response {
  Vector2cd u, du;                     // [m/V]
  Complex balance = 0, d_balance = 0;  // V_B per volt of the drive
  Complex lock;                        // turn Theta_F^T u, real: locked
  Complex lock_slope;                  // d lock / d omega
};

// Adds to the response to the drive that of the V_B which nulls the charge.
void rebalance(const Problem& problem, const Matrix2cd& inverse,
               const Matrix2cd& slope, Response& r) {
  const Vector2cd& readout = problem.modal.coupling[kReadout];
  const Vector2cd b = inverse * problem.modal.coupling[kDamping];
  const Vector2cd db = -inverse * (slope * b);
  const Complex per_gain = reciprocal(charge_of(readout, b));
  r.balance = -(charge_of(readout, r.u) + problem.feedthrough) * per_gain;
  r.d_balance =
      -(charge_of(readout, r.du) + r.balance * charge_of(readout, db)) *
      per_gain;
  r.u += r.balance * b;
  r.du += r.balance * db + r.d_balance * b;
}

Response response(const Problem& problem, double omega) {
  const ModalParameters& modal = problem.modal;
  const Matrix2cd S = stiffness_at(omega, modal.mass, problem.forces);
  Matrix2cd inverse;
  inverse << S(1, 1), -S(0, 1), -S(1, 0), S(0, 0);
  inverse *= reciprocal(S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0));
  Matrix2cd slope;
  slope.real() = -2 * omega * modal.mass * Matrix2d::Identity();
  slope.imag() = modal.mass * problem.forces.velocity;
  Response r;
  r.u = inverse * modal.coupling[kDrive];
  r.du = -inverse * (slope * r.u);
  if (problem.rebalance) rebalance(problem, inverse, slope, r);
  r.lock = problem.turn * charge_of(modal.coupling[kFeedback], r.u);
  r.lock_slope = problem.turn * charge_of(modal.coupling[kFeedback], r.du);
  return r;
}

}  // namespace

Matrix2cd dynamic_stiffness(const ModalParameters& modal, double omega,
                            const CaseMotion& motion) {
  return stiffness_at(omega, modal.mass, forces_of(modal, motion));
}

StaticSolution static_solution(const ModalParameters& modal,
                               const DriveLoop& loop, double feedthrough,
                               const CaseMotion& motion, double guess) {
  constexpr int kMaxIterations = 60;
  // Of the half width: what the last step leaves is its square.
  constexpr double kTolerance = 1e-7;
  const Problem problem{modal, forces_of(modal, motion),
                        -std::polar(1.0, std::numbers::pi / 2 - loop.pll_phase),
                        loop.mode == ReadoutMode::kForceRebalance, feedthrough};
  double omega =
      guess > 0 ? guess : std::sqrt(modal.stiffness(0, 0) / modal.mass);
  const double half_width = modal.damping(0, 0) / (2 * modal.mass);
  for (int i = 0; i < kMaxIterations; ++i) {
    Response r = response(problem, omega);
    const double slope = (r.lock_slope * reciprocal(r.lock)).imag();
    const double step =
        std::clamp(-std::arg(r.lock) / slope, -half_width, half_width);
    omega += step;
    if (!(std::abs(step) <= kTolerance * half_width)) continue;

    r.u += step * r.du;
    r.balance += step * r.d_balance;
    StaticSolution solution;
    const double wanted =
        loop.feedback_amplitude /
        std::sqrt(std::norm(charge_of(modal.coupling[kFeedback], r.u)));
    solution.drive_frequency = omega;
    solution.amplitude_locked = wanted <= loop.voltage_limit;
    solution.drive_voltage = std::min(wanted, loop.voltage_limit);
    solution.amplitude = r.u * solution.drive_voltage;
    solution.signal =
        problem.rebalance
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
