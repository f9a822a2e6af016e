// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

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

}  // namespace beamgyro::internal
