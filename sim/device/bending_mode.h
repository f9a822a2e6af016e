// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/numerics/symmetric_band.h"

namespace beamgyro::internal {

/// A stretch of beam with constant section, one finite element.
struct BeamElement {
  double length;             // [m]
  double bending_stiffness;  // E I [N m2]
  double shear_stiffness;    // kappa G A [N]; infinity = Euler-Bernoulli
  double line_density;       // rho A [kg/m]
  double rotary_inertia;     // rho I [kg m]; 0 = Euler-Bernoulli

  bool operator==(const BeamElement&) const = default;
};

struct BeamMatrices {
  SymmetricBand stiffness;  // [N/m N; N N m]
  SymmetricBand mass;       // [kg kg m; kg m kg m2]
};

/// Stiffness and consistent mass of a free-free beam from two-node elements
/// that are exact under static end loads (Hermite cubics for shear stiffness
/// infinity, else Timoshenko with Phi = 12 E I / (kappa G A h^2)). Degrees of
/// freedom w_0, theta_0, w_1, theta_1, ...
BeamMatrices assemble_beam(const std::vector<BeamElement>& elements);

struct BendingMode {
  double angular_frequency;  // [rad/s]
  Eigen::VectorXd shape;     // w_0, theta_0, w_1, ... [1, 1/m], w_0 = 1
};

/// Lowest elastic mode of the free-free beam, K phi = w^2 M phi, by inverse
/// iteration with a Rayleigh-quotient shift, started from the mode of a uniform
/// beam (1.2). Throws SimulationFailure when it does not converge.
BendingMode first_bending_mode(const std::vector<BeamElement>& elements);

/// Integrals of an Euler-Bernoulli mode shape over one element.
struct ShapeIntegrals {
  double slope_squared = 0;      // int phi'^2 dz [1/m]
  double curvature = 0;          // int phi'' dz [1/m]
  double curvature_squared = 0;  // int phi''^2 dz [1/m3]
};
ShapeIntegrals shape_integrals(const Eigen::VectorXd& shape, int element,
                               double length);

/// Deflection at `z` [m] from the left end, Hermite interpolation of a mode.
double deflection(const std::vector<BeamElement>& elements,
                  const Eigen::VectorXd& shape, double z);

/// Root b L of cos(bL) cosh(bL) = 1 for the first bending mode (1.2).
inline constexpr double kFreeFreeRoot = 4.730040744862704;

}  // namespace beamgyro::internal
