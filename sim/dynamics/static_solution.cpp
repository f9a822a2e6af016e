// SPDX-License-Identifier: MIT
#include "sim/dynamics/static_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "linear_algebra/eigenvalues.h"
#include "sim/dynamics/complex_form.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Vector2cd;

// 1/z of a z whose square is far from both ends of a double's range; the
// library's division looks after those too and takes several times as long.
Complex reciprocal(Complex z) { return std::conj(z) / std::norm(z); }

// Returns the forces, with the Euler force added to the position term.
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

// The equations that Newton's method solves at each step.
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
  Complex lock;        // turn Theta_F^T u; a lock where it is real, positive
  Complex lock_slope;  // d lock / d omega
  double omega;
  Matrix2cd inverse;        // S^-1
  Complex per_determinant;  // 1/det S
  Complex gain_slope = 0;   // of ln Theta_R^T S^-1 Theta_B, for the rebalance

  // Where arg(lock) falls with the frequency, the loop pulls towards it.
  bool is_stable() const { return (lock_slope * std::conj(lock)).imag() < 0; }
};

// Adds to the response to the drive that of the V_B which nulls the charge.
void rebalance(const Problem& problem, const Matrix2cd& slope, Response& r) {
  const Vector2cd& readout = problem.modal.coupling[kReadout];
  const Vector2cd b = r.inverse * problem.modal.coupling[kDamping];
  const Vector2cd db = -r.inverse * (slope * b);
  const Complex per_gain = reciprocal(charge_of(readout, b));
  r.balance = -(charge_of(readout, r.u) + problem.feedthrough) * per_gain;
  r.d_balance =
      -(charge_of(readout, r.du) + r.balance * charge_of(readout, db)) *
      per_gain;
  r.u += r.balance * b;
  r.du += r.balance * db + r.d_balance * b;
  r.gain_slope = charge_of(readout, db) * per_gain;
}

// dS/domega of the two modes alone.
Matrix2cd two_mode_slope(const Problem& problem, double omega) {
  const double mass = problem.modal.mass;
  Matrix2cd slope;
  slope.real() = -2 * omega * mass * Matrix2d::Identity();
  slope.imag() = mass * problem.forces.velocity;
  return slope;
}

// Fills in what follows from S^-1 and `slope`, dS/domega.
void respond(const Problem& problem, const Matrix2cd& slope, Response& r) {
  const ModalParameters& modal = problem.modal;
  r.u = r.inverse * modal.coupling[kDrive];
  r.du = -r.inverse * (slope * r.u);
  if (problem.rebalance) rebalance(problem, slope, r);
  r.lock = problem.turn * charge_of(modal.coupling[kFeedback], r.u);
  r.lock_slope = problem.turn * charge_of(modal.coupling[kFeedback], r.du);
}

Response response(const Problem& problem, double omega) {
  const ModalParameters& modal = problem.modal;
  Matrix2cd S = stiffness_at(omega, modal.mass, problem.forces);
  Matrix2cd slope = two_mode_slope(problem, omega);
  if (!modal.spurious.empty()) {
    const SpuriousStiffness spurious =
        spurious_stiffness(modal.spurious, omega);
    S += spurious.value;
    slope += spurious.slope;
  }
  Response r;
  r.omega = omega;
  r.inverse << S(1, 1), -S(0, 1), -S(1, 0), S(0, 0);
  r.per_determinant = reciprocal(S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0));
  r.inverse *= r.per_determinant;
  respond(problem, slope, r);
  return r;
}

// A frequency that satisfies the phase condition, and the response there.
struct Lock {
  double omega;
  Response response;
};

// Newton's method from `omega`, steps of `half_width` at most. Whether it
// converges to a lock.
bool find_lock(const Problem& problem, double omega, double half_width,
               Lock& lock) {
  constexpr int kMaxIterations = 60;
  // Of the half width: what the last step leaves is its square.
  constexpr double kTolerance = 1e-7;
  for (int i = 0; i < kMaxIterations; ++i) {
    Response& r = lock.response = response(problem, omega);
    const double slope = (r.lock_slope * reciprocal(r.lock)).imag();
    const double step =
        std::clamp(-std::arg(r.lock) / slope, -half_width, half_width);
    omega += step;
    if (!(std::abs(step) <= kTolerance * half_width)) continue;
    r.u += step * r.du;
    r.balance += step * r.d_balance;
    lock.omega = omega;
    return true;
  }
  return false;
}

// The imaginary part of a conj(b).
double imag_of(Complex a, Complex b) {
  return a.imag() * b.real() - a.real() * b.imag();
}

// lock = (zero0 + zero1 s) / (1 + pole1 s + pole2 s^2) at the omega whose
// square is that of a response + 2 omega s, but for (s/omega)^2 of the damping.
// The imaginary part of one polynomial times the other conjugated is a cubic,
// zero at every s that satisfies the phase condition.
struct LockCurve {
  Complex zero0, zero1, pole1, pole2;
  std::array<double, 4> cubic;

  LockCurve(const Problem& problem, const Response& r) : zero0(r.lock) {
    const double inertia = -2 * r.omega * problem.modal.mass;
    const Matrix2d losses = problem.modal.mass * problem.forces.velocity;
    // Trace of S^-1 dS/domega; det dS/domega over det S.
    const Complex by_losses =
        r.inverse(0, 0) * losses(0, 0) + r.inverse(0, 1) * losses(1, 0) +
        r.inverse(1, 0) * losses(0, 1) + r.inverse(1, 1) * losses(1, 1);
    pole1 = inertia * (r.inverse(0, 0) + r.inverse(1, 1)) +
            Complex(-by_losses.imag(), by_losses.real());
    pole2 = Complex(inertia * inertia - losses(0, 0) * losses(1, 1) +
                        losses(0, 1) * losses(1, 0),
                    inertia * (losses(0, 0) + losses(1, 1))) *
            r.per_determinant;
    if (problem.rebalance) {  // V_B leaves one mode
      pole1 += r.gain_slope;
      pole2 = 0;
    }
    zero1 = r.lock_slope + r.lock * pole1;
    cubic = {zero0.imag(), zero1.imag() + imag_of(zero0, pole1),
             imag_of(zero1, pole1) + imag_of(zero0, pole2),
             imag_of(zero1, pole2)};
  }

  // Returns whether the loop is stable at a root of the cubic.
  bool is_stable_lock(double s) const {
    const double slope = cubic[1] + s * (2 * cubic[2] + 3 * s * cubic[3]);
    return slope < 0 &&
           ((zero0 + zero1 * s) * std::conj(1.0 + s * (pole1 + s * pole2)))
                   .real() > 0;
  }
};

// Spurious modes count with the stiffness that they have at the response's
// frequency: they are coupled too weakly to make a lock of their own.
LockCurve lock_curve(const Problem& problem, const Response& r) {
  if (problem.modal.spurious.empty()) return {problem, r};
  Response two_modes = r;
  respond(problem, two_mode_slope(problem, r.omega), two_modes);
  return {problem, two_modes};
}

// Returns whether there is another stable frequency.
bool has_rival(const Problem& problem, const Lock& lock) {
  const LockCurve curve = lock_curve(problem, lock.response);
  const auto& [c0, c1, c2, c3] = curve.cubic;  // c0 is zero but for roundoff
  const double discriminant = c2 * c2 - 4 * c1 * c3;
  if (!(discriminant >= 0)) return false;
  const double q = -0.5 * (c2 + std::copysign(std::sqrt(discriminant), c2));
  const auto is_rival = [&](double s) {
    return s > -0.5 * lock.omega && s < 2 * lock.omega &&
           curve.is_stable_lock(s);
  };
  return is_rival(q / c3) || is_rival(c1 / q);
}

// Returns all stable frequencies; `omega` is near the modes.
std::vector<Lock> stable_locks(const Problem& problem, double omega,
                               double half_width) {
  const LockCurve curve = lock_curve(problem, response(problem, omega));
  // In half widths and divided by the highest power that is there.
  std::array<double, 4> c = curve.cubic;
  double scale = 1, largest = 0;
  for (double& value : c) {
    value *= scale;
    scale *= half_width;
    largest += std::abs(value);
  }
  int degree = 3;
  while (degree > 0 &&
         std::abs(c[static_cast<std::size_t>(degree)]) < 1e-12 * largest)
    --degree;
  std::vector<Lock> locks;
  if (degree == 0 || !std::isfinite(largest)) return locks;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  for (int k = 0; k < degree; ++k) {
    companion(k, degree - 1) =
        -c[static_cast<std::size_t>(k)] / c[static_cast<std::size_t>(degree)];
    if (k > 0) companion(k, k - 1) = 1;
  }
  for (const Complex& root : eigenvalues_of(companion)) {
    const double square =
        omega * (omega + 2 * half_width * root.real());  // [1/s2]
    if (!(square > 0)) continue;
    Lock lock;
    if (!find_lock(problem, std::sqrt(square), half_width, lock) ||
        !lock.response.is_stable())
      continue;
    const auto is_same = [&](const Lock& other) {
      return std::abs(other.omega - lock.omega) < 1e-4 * half_width;
    };
    if (std::none_of(locks.begin(), locks.end(), is_same))
      locks.push_back(lock);
  }
  return locks;
}

// Of several: the nearest to `guess`, without one that of the lowest voltage.
const Lock& chosen(const std::vector<Lock>& locks, double guess) {
  const auto cost = [&](const Lock& lock) {
    return guess > 0 ? std::abs(lock.omega - guess)
                     : 1 / std::norm(lock.response.lock);
  };
  return *std::min_element(
      locks.begin(), locks.end(),
      [&](const Lock& a, const Lock& b) { return cost(a) < cost(b); });
}

StaticSolution solution_at(const Lock& lock, const Problem& problem,
                           const DriveLoop& loop) {
  const ModalParameters& modal = problem.modal;
  const Response& r = lock.response;
  StaticSolution solution;
  const double wanted =
      loop.feedback_amplitude /
      std::sqrt(std::norm(charge_of(modal.coupling[kFeedback], r.u)));
  solution.drive_frequency = lock.omega;
  solution.amplitude_locked = wanted <= loop.voltage_limit;
  solution.drive_voltage = std::min(wanted, loop.voltage_limit);
  solution.amplitude = r.u * solution.drive_voltage;
  solution.signal =
      problem.rebalance
          ? r.balance * solution.drive_voltage
          : charge_of(modal.coupling[kReadout], solution.amplitude) +
                problem.feedthrough * solution.drive_voltage;
  return solution;
}

}  // namespace

ModeForces mode_forces(const Eigen::Matrix2d& stiffness,
                       const Eigen::Matrix2d& damping, double gain,
                       const CaseMotion& motion) {
  const double Ox = motion.x, Oy = motion.y, Oz = motion.z;
  ModeForces forces{stiffness, damping};
  forces.position(0, 0) -= gain * (Oy * Oy + Oz * Oz);
  forces.position(0, 1) += gain * Ox * Oy;
  forces.position(1, 0) += gain * Ox * Oy;
  forces.position(1, 1) -= gain * (Ox * Ox + Oz * Oz);
  forces.velocity(0, 1) += 2 * gain * (motion.in_phase - Oz);
  forces.velocity(1, 0) += 2 * gain * (motion.in_phase + Oz);
  return forces;
}

Eigen::Matrix2d euler_force(double gain, const CaseMotion& motion) {
  Eigen::Matrix2d force;
  force << 0, -gain * motion.z_acceleration, gain * motion.z_acceleration, 0;
  return force;
}

Matrix2cd dynamic_stiffness(const ModalParameters& modal, double omega,
                            const CaseMotion& motion) {
  Matrix2cd S = stiffness_at(omega, modal.mass, forces_of(modal, motion));
  if (!modal.spurious.empty())
    S += spurious_stiffness(modal.spurious, omega).value;
  return S;
}

Matrix2cd dynamic_stiffness_slope(const ModalParameters& modal, double omega) {
  Matrix2cd slope = Complex(0, 1) * modal.damping -
                    2 * omega * modal.mass * Matrix2cd::Identity();
  if (!modal.spurious.empty())
    slope += spurious_stiffness(modal.spurious, omega).slope;
  return slope;
}

Matrix2d damping_at(const ModalParameters& modal, double omega) {
  if (modal.spurious.empty()) return modal.damping;
  return modal.damping +
         spurious_stiffness(modal.spurious, omega).value.imag() / omega;
}

StaticSolution static_solution(const ModalParameters& modal,
                               const DriveLoop& loop, double feedthrough,
                               const CaseMotion& motion, double guess) {
  const Problem problem{modal, forces_of(modal, motion),
                        -std::polar(1.0, std::numbers::pi / 2 - loop.pll_phase),
                        loop.mode == ReadoutMode::kForceRebalance, feedthrough};
  const double own = std::sqrt(modal.stiffness(0, 0) / modal.mass);
  const double half_width = modal.damping(0, 0) / (2 * modal.mass);
  Lock lock;
  bool is_only =
      find_lock(problem, guess > 0 ? guess : own, half_width, lock) &&
      lock.response.is_stable() && !has_rival(problem, lock);
  if (!is_only) {
    const std::vector<Lock> locks = stable_locks(problem, own, half_width);
    if (locks.empty()) {
      throw SimulationFailure(fmt::format(
          "drive loop: no frequency near {:.2f} Hz satisfies the phase "
          "condition; the loop cannot lock",
          own / (2 * std::numbers::pi)));
    }
    lock = chosen(locks, guess);
    is_only = locks.size() == 1;
  }
  StaticSolution solution = solution_at(lock, problem, loop);
  solution.only_lock = is_only;
  return solution;
}

}  // namespace beamgyro::internal
