// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace beamgyro::internal {

/// Quadrature of one gyro over the scaled temperature t, from -1 to 1:
///
///   q(t) = Σ_n smooth_n t^n - Σ_k heights_k u_k / (1 + u_k^2)
///   u_k = 2 (t - places_k) / widths_k,   t = T + Σ_j shares_j z_j
struct QuadratureFit {
  Eigen::VectorXd shares;  // of the columns z in the beam's temperature
  Eigen::VectorXd smooth;
  Eigen::VectorXd places, widths, heights;  // one for each resonance
  double rms = 0.0;                         // of the residual
};

/// What fit_quadrature() may choose.
struct QuadratureFitOptions {
  int degree = 3;                         // of the smooth part
  int most = 8;                           // resonances
  double narrowest = 0.03, widest = 1.2;  // width at half height, scaled
  double noise = 1e-4;  // of a row, scaled; less is not looked for
};

/// Fits places, widths, heights and shares to measured q at T and z, one row
/// each, of which at most kMostQuadratureRows are taken, evenly. One resonance
/// after the other is added where it takes away most, and all are refined by
/// Levenberg and Marquardt's method on the residual that heights and smooth
/// part leave (variable projection). Of all numbers of resonances, also without
/// earlier ones, the one is kept with the least
///
///   n ln(max(RSS / n, noise^2)) + k ln n + Σ (height / 2)^2
///
/// where k counts the parameters. Places lie up to half of the range beyond its
/// ends. The work is bounded, the result the same each time.
QuadratureFit fit_quadrature(const Eigen::VectorXd& T, const Eigen::MatrixXd& z,
                             const Eigen::VectorXd& q,
                             const QuadratureFitOptions& options = {});

constexpr Eigen::Index kMostQuadratureRows = 1500;

}  // namespace beamgyro::internal
