// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>

#include "sim/device/modal_model.h"
#include "sim/dynamics/mode_forces.h"

namespace beamgyro::internal {

/// The quantities that the loops hold constant (2.1, 2.5).
struct DriveLoop {
  double feedback_amplitude;  // |Theta_Fx(T_0)| A_ref [C]
  double pll_phase;           // phi_pll [rad]
  double voltage_limit;       // V_max [V]
  ReadoutMode mode = ReadoutMode::kOpenLoop;
};

/// Periodic state of the driven beam, q = Re[u e^{i theta}], drive voltage
/// V_D cos(theta).
struct StaticSolution {
  double drive_frequency;      // w_d [rad/s]
  double drive_voltage;        // V_D [V]
  Eigen::Vector2cd amplitude;  // u = (X, Y) [m]
  /// Open loop: the charge Theta_R^T u + C_ft V_D [C]. Force rebalance: the
  /// voltage V_B on the damping patch that keeps that charge at zero [V].
  std::complex<double> signal;
  bool amplitude_locked;  // false when V_D stands at its limit
  bool only_lock;         // false when there is another stable lock
};

/// S(w) of (2.10): K + N - w^2 M + i w (C + G), with the
/// forces of mode_forces() and euler_force().
Eigen::Matrix2cd dynamic_stiffness(const ModalParameters& modal, double omega,
                                   const CaseMotion& motion);

/// Returns the exact steady state with the drive loop closed: the frequency at
/// which delta = arg(-Theta_F^T u) + 90 deg - phi_pll is zero, u = S^-1 Theta_D
/// V_D, and the voltage at which |Theta_F^T u| has its set value (2.1, 2.10).
/// With force rebalance V_B is part of the solution (2.5).
///
/// A lock is stable only where delta falls with the frequency. Two strongly
/// coupled modes have two stable locks with an unstable one between them. Then
/// the result is the lock nearest to `guess` [rad/s] or, if that is 0, the one
/// with the lowest voltage. The method is Newton's on the phase, with its exact
/// derivative, starting from `guess` or from the frequency of the drive mode.
/// Throws SimulationFailure when there is no stable lock.
StaticSolution static_solution(const ModalParameters& modal,
                               const DriveLoop& loop, double feedthrough,
                               const CaseMotion& motion, double guess = 0);

}  // namespace beamgyro::internal
