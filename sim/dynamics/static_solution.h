// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <complex>

#include "sim/device/modal_model.h"

namespace beamgyro::internal {

/// Inertial motion of the case: rotation about x, y and z (the input axis), and
/// the in-phase term that its acceleration causes.
struct CaseMotion {
  double x = 0, y = 0, z = 0;  // [rad/s]
  double z_acceleration = 0;   // dOmega_z/dt, an independent input [rad/s2]
  double in_phase = 0;         // b_g . a + r |a|^2, see in_phase_rate() [rad/s]
};

/// The forces on the two modes in the moving case, divided by the modal mass
/// (2.1):
///   q'' = f/m - velocity q' - position q
/// `velocity` [1/s] holds damping, the Coriolis force 2 gamma Omega_z J2 and
/// the in-phase term of the motion, c_xy/m += 2 gamma in_phase. `position`
/// [1/s2] holds stiffness and centrifugal force. The Euler force is separate,
/// see euler_force().
struct ModeForces {
  Eigen::Matrix2d position, velocity;
};

/// `stiffness` is K/m [1/s2], `damping` C/m [1/s], `gain` the angular gain
/// gamma = m_g/m.
ModeForces mode_forces(const Eigen::Matrix2d& stiffness,
                       const Eigen::Matrix2d& damping, double gain,
                       const CaseMotion& motion);

/// Returns what the Euler force adds to `position`: gamma Omega_z' J2 [1/s2].
Eigen::Matrix2d euler_force(double gain, const CaseMotion& motion);

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

/// S(w) of (2.10): K + N - w^2 M + i w (C + G) + dK(w), with the forces of
/// mode_forces() and euler_force() and the stiffness dK of spurious modes
/// (13.3).
Eigen::Matrix2cd dynamic_stiffness(const ModalParameters& modal, double omega,
                                   const CaseMotion& motion);

/// Returns dS/dw at rest.
Eigen::Matrix2cd dynamic_stiffness_slope(const ModalParameters& modal,
                                         double omega);

/// Returns C + Im dK(w)/w, what takes energy from the two modes [N s/m].
Eigen::Matrix2d damping_at(const ModalParameters& modal, double omega);

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
