// SPDX-License-Identifier: MIT
#pragma once

#include <complex>

#include "sim/device/device.h"
#include "sim/memory/memory_parameters.h"

namespace beamgyro::internal {

using Complex = std::complex<double>;

/// Time constant [s] of a glass transition: WLF with the universal constants
/// above T_g, log10(tau/100 s) = -17.44 (T-T_g)/(51.6 K + T-T_g), Arrhenius
/// with `low_activation` [J/mol] below, 100 s at T_g. T, T_g in [K].
double glass_time_constant(double T, double glass_transition,
                           double low_activation);

/// Arrhenius time constant [s] of a relaxation whose loss peak is at 1 Hz at
/// T_1: tau = exp[(E/R)(1/T - 1/T_1)] / (2 pi).
double arrhenius_time_constant(double T, double activation, double T_1);

/// Zener's thermoelastic loss factor of the beam in bending:
/// Phi = E cte^2 T/(rho c) w t_z/(1 + (w t_z)^2), t_z = a^2 rho c/(pi^2 k).
double thermoelastic_loss(const BeamParameters& beam, double T, double omega);

/// E_b* [Pa], complex Young's modulus of the beam with thermal expansion and
/// thermoelastic loss at angular frequency `omega` [rad/s] (1.3).
Complex beam_modulus(const BeamParameters& beam, double T, double omega);

/// The linear temperature coefficients of the ceramic hold from -40 to +80 degC
/// and are clamped outside.
inline constexpr double kColdestCeramic = 233.15, kHottestCeramic = 353.15;

/// E_p* [Pa], complex short-circuit modulus of the patches (1.3).
Complex patch_modulus(const PatchParameters& patches, double T);

/// |e31| [C/m2] real part rule and permittivity of the patches: e31* = |d31|
/// (1 + tc dT) E_p*, eps33S = eps33T (1 + tc dT) - |d31|^2 E_p (beam form).
Complex piezo_stress_constant(const PatchParameters& patches, double T);
double clamped_permittivity(const PatchParameters& patches, double T);

/// G_b* [Pa], complex shear modulus of the bond with its beta and alpha
/// relaxations (Cole-Cole form) (1.3).
Complex bond_modulus(const BondParameters& bond, double T, double omega);

/// The same of a glass that is `offset` [K] away from the reference glass
/// (12.2).
Complex bond_modulus(const BondParameters& bond,
                     const RelaxationParameters& relaxation, double offset,
                     double T, double omega);

/// S* = 1 - tanh(q)/q, share of the face strain that reaches a patch through
/// its bond, q = (l_p/2) sqrt(G_b*/(t_b E_p* t_p)) (1.3).
Complex shear_lag(Complex q);
Complex shear_lag(const PatchParameters& patches, double bond_thickness,
                  Complex bond_modulus, Complex patch_modulus);

/// kappa_m* = k_m [ratio + (i w tau)^a]/[1 + (i w tau)^a], stiffness of the
/// elastomer node mount as a share of the modal stiffness (1.3).
Complex mount_share(const MountParameters& mount, double T, double omega);

}  // namespace beamgyro::internal
