// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "dataset/random_stream.h"

namespace beamgyro {

/// A linear system driven by white noise,
///   dz = A z dt + B dW,
/// n states z, m independent unit Wiener processes W. The states may have any
/// units and sizes.
struct NoiseSystem {
  Eigen::MatrixXd A;  // n x n [1/s]
  Eigen::MatrixXd B;  // n x m [1/sqrt(s)] times the unit of the state
};

/// The same system seen at the times k h, with n independent unit normals n_k:
///   z_{k+1} = Phi z_k + L n_k,   Phi = e^{A h},
///   L L^T = Q_h = int_0^h e^{A s} B B^T e^{A^T s} ds.
struct SampledNoise {
  Eigen::MatrixXd transition;  // Phi, n x n
  Eigen::MatrixXd root;        // L, n x n, lower triangular, diagonal >= 0
};

/// Exact for any A, h [s] > 0 and B, of whatever rank. Van Loan's block
/// exponential holds e^{-A h} and loses every digit when A h is large; instead
/// a Legendre expansion of e^{A s} B over a step that is short for all of A,
/// and then steps of twice the length,
///   Q_2h = Phi_h Q_h Phi_h^T + Q_h,   Phi_2h = Phi_h^2,
/// in terms of L and Phi - 1, so that weakly driven states and slow decays keep
/// their digits. Throws std::invalid_argument for an interval not above 0,
/// shapes that do not fit, elements not finite, or e^{A h} too large for a
/// double.
SampledNoise sampled_noise(const NoiseSystem& system, double interval);

/// Lower triangular root of the stationary covariance Sigma,
///   A Sigma + Sigma A^T + B B^T = 0,
/// as the limit of the doubling. Throws std::invalid_argument as above, and
/// when an eigenvalue of A has a real part not below 0.
Eigen::MatrixXd stationary_root(const NoiseSystem& system);

/// One realisation at the times k h, stationary from its first sample on. It
/// takes n normal numbers a sample, whatever B.
class LinearNoise {
 public:
  /// Throws as sampled_noise() and stationary_root().
  LinearNoise(const NoiseSystem& system, double interval,
              const RandomStream& stream);

  /// z at the present sample.
  const Eigen::VectorXd& state() const { return state_; }

  /// On to the next sample.
  void advance();

  /// Other coefficients from here on, for the same states; z stays. Throws as
  /// sampled_noise(), or for another number of states.
  void refresh(const NoiseSystem& system);

 private:
  double interval_;  // [s]
  RandomStream stream_;
  Eigen::VectorXd state_;
  Eigen::MatrixXd step_;     // [Phi L]
  Eigen::VectorXd driven_;   // z and the normal numbers of one step
  Eigen::MatrixXd normals_;  // one column a sample, drawn ahead
  Eigen::Index next_;        // its first unused column
};

}  // namespace beamgyro
