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

Matrix2d coriolis(const ModalParameters& modal, double z) {
  const double g = 2 * modal.coriolis_mass * z;
  Matrix2d G;
  G << 0, -g, g, 0;
  return G;
}

struct Response {
  Vector2cd u;         // [m/V]
  Complex lock;        // -Theta_F^T u e^{i(90 deg - phi_pll)}, real when locked
  Complex lock_slope;  // d lock / d omega
};

Response response(const ModalParameters& modal, double omega, double pll_phase,
                  const CaseRotation& rotation) {
  const Matrix2cd inverse = dynamic_stiffness(modal, omega, rotation).inverse();
  const Matrix2cd slope =
      Complex(0, 1) * (modal.damping + coriolis(modal, rotation.z)) -
      2 * omega * modal.mass * Matrix2d::Identity().cast<Complex>();
  Response r;
  r.u = inverse * modal.coupling[kDrive];
  const Vector2cd du = -inverse * (slope * r.u);
  const Complex turn = std::polar(1.0, std::numbers::pi / 2 - pll_phase);
  r.lock = -turn * charge_of(modal.coupling[kFeedback], r.u);
  r.lock_slope = -turn * charge_of(modal.coupling[kFeedback], du);
  return r;
}

}  // namespace

Matrix2cd dynamic_stiffness(const ModalParameters& modal, double omega,
                            const CaseRotation& rotation) {
  const auto [Ox, Oy, Oz, dOz] = rotation;
  Matrix2d N;
  N << -(Oy * Oy + Oz * Oz), Ox * Oy - dOz, Ox * Oy + dOz, -(Ox * Ox + Oz * Oz);
  const Matrix2d real = modal.stiffness + modal.coriolis_mass * N -
                        omega * omega * modal.mass * Matrix2d::Identity();
  const Matrix2d imaginary = omega * (modal.damping + coriolis(modal, Oz));
  return real.cast<Complex>() + Complex(0, 1) * imaginary.cast<Complex>();
}

StaticSolution static_solution(const ModalParameters& modal,
                               const DriveLoop& loop, double feedthrough,
                               const CaseRotation& rotation) {
  constexpr int kMaxIterations = 60;
  constexpr double kTolerance = 1e-13;  // of the frequency, relative
  double omega = std::sqrt(modal.stiffness(0, 0) / modal.mass);
  const double half_width = modal.damping(0, 0) / (2 * modal.mass);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Response r = response(modal, omega, loop.pll_phase, rotation);
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
    solution.charge = charge_of(modal.coupling[kReadout], solution.amplitude) +
                      feedthrough * solution.drive_voltage;
    return solution;
  }
  throw std::runtime_error(
      fmt::format("drive loop: no frequency near {:.2f} Hz satisfies the phase "
                  "condition; the loop cannot lock",
                  omega / (2 * std::numbers::pi)));
}

}  // namespace beamgyro
