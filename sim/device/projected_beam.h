// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/device/device.h"
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

/// Root b L of cos(bL) cosh(bL) = 1 for the first bending mode (1.2).
inline constexpr double kFreeFreeRoot = 4.730040744862704;

/// Distance of a patch centre from the beam axis along its face normal,
/// h_p = a/2 + t_b + t_p/2 [m].
double lever_arm(const DeviceParameters& device, double bond_thickness);

/// Elements of the symmetric unit at T_0, as Timoshenko beam: shear-lag factor
/// 1, mean bond thickness, no bond mass, shear area of the metal alone, nodes
/// on patch edges and supports (1.4).
struct CompositeBeam {
  std::vector<BeamElement> elements;
  std::vector<bool> under_patches, between_pins;  // one per element
};
CompositeBeam composite_beam(const DeviceParameters& device, int elements);

/// What the finite-element solution of a unit leaves behind: its first bending
/// mode at T_0 with symmetric sections, reduced to integrals (1.4). The modal
/// coordinate is the displacement of the beam tip, phi(0) = 1.
struct ProjectedBeam {
  double euler_frequency;       // 2 pi f_EB of the composite beam [rad/s]
  double timoshenko_frequency;  // 2 pi f_T, where materials are taken [rad/s]
  double mass;                  // m = int rho A phi^2 dz [kg]
  double stiffness_scale;       // kscale = (f_T/f_EB)^2
  double angular_gain;          // gamma, Coriolis over modal mass
  double curvature_squared;     // J, whole beam [1/m3]
  double patch_curvature_squared;     // J_p, under the patches [1/m3]
  double patch_curvature;             // int phi'' dz under a patch [1/m]
  double slope_squared_between_pins;  // int phi'^2 dz [1/m]
};

/// Number of elements of `project_beam`; the frequency error at n elements is
/// 4e-10 (n/120)^-4 for Euler-Bernoulli and 2.4e-6 (n/120)^-2 for Timoshenko.
inline constexpr int kBeamElements = 120;

/// Solves the composite beam twice, as Euler-Bernoulli beam for shape and
/// integrals and as Timoshenko beam for the frequency (1.4).
ProjectedBeam project_beam(const DeviceParameters& device,
                           int elements = kBeamElements);

/// Position of the two supports, as a share of the beam length from its ends.
inline constexpr double kSupportPosition = 0.231;

}  // namespace beamgyro::internal
