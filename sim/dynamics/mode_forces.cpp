// SPDX-License-Identifier: MIT
#include "sim/dynamics/mode_forces.h"

namespace beamgyro::internal {

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

}  // namespace beamgyro::internal
