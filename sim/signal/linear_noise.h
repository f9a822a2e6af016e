// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "random/random_stream.h"
#include "sim/numerics/state_archive.h"

namespace beamgyro::internal {

/// A linear system driven by white noise,
///   dz = A z dt + B dW,
/// with n states z and m independent unit Wiener processes W. The states may
/// have any units and magnitudes.
struct NoiseSystem {
  Eigen::MatrixXd A;  // n x n [1/s]
  Eigen::MatrixXd B;  // n x m [1/sqrt(s)] times the unit of the state
};

/// The same system at the times k h, with n independent unit normals n_k:
///   z_{k+1} = Phi z_k + L n_k,   Phi = e^{A h},
///   L L^T = Q_h = int_0^h e^{A s} B B^T e^{A^T s} ds.
struct SampledNoise {
  Eigen::MatrixXd transition;  // Phi, n x n
  Eigen::MatrixXd root;        // L, n x n, lower triangular, diagonal >= 0
};

/// Samples the system at the interval h [s] > 0. It is exact for any A and for
/// B of any rank. Van Loan's block exponential contains e^{-A h} and loses
/// every digit when A h is large. So sampling starts with a Legendre series of
/// e^{A s} B over a step that is short for all of A, and then doubles the step,
///   Q_2h = Phi_h Q_h Phi_h^T + Q_h,   Phi_2h = Phi_h^2,
/// in terms of L and Phi - 1, which keeps the digits of weakly driven states
/// and slow decays. Throws std::invalid_argument for an interval not above 0,
/// shapes that do not fit, elements not finite, or e^{A h} too large for a
/// double.
SampledNoise sampled_noise(const NoiseSystem& system, double interval);

/// Returns the largest real part of the eigenvalues of A [1/s]: a system below
/// 0 is stable. Throws std::invalid_argument as above for A.
double growth_rate(const NoiseSystem& system);

/// Returns the lower triangular root of the stationary covariance Sigma,
///   A Sigma + Sigma A^T + B B^T = 0,
/// as the limit of the doubling. Throws std::invalid_argument as above, and
/// when growth_rate() is not below 0.
Eigen::MatrixXd stationary_root(const NoiseSystem& system);

/// One realisation at the times k h, stationary from the first sample. It draws
/// n normal numbers for each sample, whatever B is.
class LinearNoise {
 public:
  /// Throws as sampled_noise() and stationary_root().
  LinearNoise(const NoiseSystem& system, double interval,
              const RandomStream& stream);

  /// Returns z at the present sample.
  const Eigen::VectorXd& state() const { return state_; }

  /// Advances to the next sample.
  void advance();

  /// Takes the last advance() back; call once after it.
  void undo();

  /// Replaces the coefficients from here on, for the same states. z stays.
  /// Throws as sampled_noise(), or for another number of states.
  void refresh(const NoiseSystem& system);

  /// Takes the state, not the coefficients.
  void archive(StateArchive& archive);

 private:
  double interval_;  // [s]
  RandomStream stream_;
  Eigen::VectorXd state_, before_;  // before_: the sample before
  Eigen::MatrixXd step_;            // [Phi L]
  Eigen::VectorXd driven_;          // z and the normal numbers of one step
  Eigen::MatrixXd normals_;         // one column a sample, drawn ahead
  Eigen::Index next_;               // its first unused column
};

}  // namespace beamgyro::internal
