// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace beamgyro::internal {

/// The slow manifold of two modes, second order (2.13), per mass:
///
///   U' = A U + B f - D f',   q = Re[U e^{i theta}], force Re[f e^{i theta}],
///   P = 2 i w + V,  S_0 = K - w^2 + i w V,  R = P^-1,
///   B = (1 + R R S_0) R,  A = -B S_0,  D = R R.
///
/// K [1/s2] is the stiffness with the centrifugal terms and without the Euler
/// force. V [1/s] is the force per velocity, damping and Coriolis. w = theta'.
class EnvelopePlant {
 public:
  EnvelopePlant(const Eigen::Matrix2d& stiffness,
                const Eigen::Matrix2d& velocity, double omega);

  const Eigen::Matrix2cd& from_amplitude() const { return a_; }
  const Eigen::Matrix2cd& from_force() const { return b_; }
  const Eigen::Matrix2cd& from_force_rate() const { return d_; }

  /// Derivatives of A, B and D by one parameter.
  struct Slope {
    Eigen::Matrix2cd A, B, D;
  };
  Slope by_frequency() const;
  /// Returns the derivatives by a parameter, given the derivatives of K and V
  /// by it.
  Slope by(const Eigen::Matrix2d& stiffness,
           const Eigen::Matrix2d& velocity) const;

 private:
  Slope slope(const Eigen::Matrix2cd& dP, const Eigen::Matrix2cd& dS) const;

  double omega_;
  Eigen::Matrix2d velocity_;
  Eigen::Matrix2cd r_, s_, a_, b_, d_;
};

}  // namespace beamgyro::internal
