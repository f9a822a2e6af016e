// SPDX-License-Identifier: MIT
#include "sim/device/materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/memory/bond_relaxation.h"

namespace beamgyro::internal {
namespace {

constexpr double kVacuumPermittivity = 8.8541878128e-12;  // [F/m]

// Cole-Cole variable (i w tau)^a.
Complex cole_cole(double omega, double tau, double exponent) {
  return std::polar(std::pow(omega * tau, exponent),
                    exponent * std::numbers::pi / 2);
}

// T - T_0 where the linear coefficients of the ceramic hold [K].
double ceramic_temperature_difference(double T) {
  return std::clamp(T, kColdestCeramic, kHottestCeramic) -
         kCalibrationTemperature;
}

// G_b* with the time constant of the alpha relaxation given.
Complex relaxed_modulus(const BondParameters& bond, double unrelaxed,
                        double tau_alpha, double T, double omega) {
  const double tau_beta =
      arrhenius_time_constant(T, bond.beta_activation, bond.beta_temperature);
  return unrelaxed -
         bond.beta_step /
             (1.0 + cole_cole(omega, tau_beta, bond.beta_exponent)) -
         bond.alpha_step /
             (1.0 + cole_cole(omega, tau_alpha, bond.alpha_exponent));
}

double d31_magnitude(const PatchParameters& patches, double T) {
  return std::abs(patches.d31) *
         (1 + patches.d31_tc * ceramic_temperature_difference(T));
}

}  // namespace

double glass_time_constant(double T, double glass_transition,
                           double low_activation) {
  constexpr double kTau = 100;               // at T_g [s]
  constexpr double kC1 = 17.44, kC2 = 51.6;  // universal WLF [1, K]
  const double above = T - glass_transition;
  if (above >= 0) return kTau * std::pow(10.0, -kC1 * above / (kC2 + above));
  return kTau * std::exp(low_activation / kGasConstant *
                         (1 / T - 1 / glass_transition));
}

double arrhenius_time_constant(double T, double activation, double T_1) {
  return std::exp(activation / kGasConstant * (1 / T - 1 / T_1)) /
         (2 * std::numbers::pi);
}

double thermoelastic_loss(const BeamParameters& beam, double T, double omega) {
  const double heat_per_volume = beam.density * beam.specific_heat;
  const double tau =
      beam.side * beam.side * heat_per_volume /
      (std::numbers::pi * std::numbers::pi * beam.thermal_conductivity);
  const double wt = omega * tau;
  return beam.youngs_modulus * beam.thermal_expansion * beam.thermal_expansion *
         T / heat_per_volume * wt / (1 + wt * wt);
}

Complex beam_modulus(const BeamParameters& beam, double T, double omega) {
  const double dT = T - kCalibrationTemperature;
  const double storage =
      beam.youngs_modulus *
      (1 + beam.modulus_tc1 * dT + beam.modulus_tc2 * dT * dT) *
      (1 + beam.thermal_expansion * dT);
  return storage *
         Complex(1, beam.loss_factor + thermoelastic_loss(beam, T, omega));
}

Complex patch_modulus(const PatchParameters& patches, double T) {
  const double dT = ceramic_temperature_difference(T);
  return patches.youngs_modulus * (1 + patches.modulus_tc * dT) *
         Complex(1, patches.mechanical_loss_factor *
                        (1 + patches.mechanical_loss_tc * dT));
}

Complex piezo_stress_constant(const PatchParameters& patches, double T) {
  return d31_magnitude(patches, T) * patch_modulus(patches, T);
}

double clamped_permittivity(const PatchParameters& patches, double T) {
  const double dT = ceramic_temperature_difference(T);
  const double d31 = d31_magnitude(patches, T);
  return kVacuumPermittivity * patches.relative_permittivity *
             (1 + patches.permittivity_tc * dT) -
         d31 * d31 * patch_modulus(patches, T).real();
}

Complex bond_modulus(const BondParameters& bond, double T, double omega) {
  return relaxed_modulus(
      bond, bond.shear_modulus,
      glass_time_constant(T, bond.glass_transition, bond.alpha_low_activation),
      T, omega);
}

Complex bond_modulus(const BondParameters& bond,
                     const RelaxationParameters& relaxation, double offset,
                     double T, double omega) {
  const double reference =
      reference_fictive_temperature(T, bond.glass_transition);
  const double share = (1 - relaxation.nonlinearity) * relaxation.activation /
                       kGasConstant *
                       (1 / (reference + offset) - 1 / reference);
  return relaxed_modulus(
      bond, bond.shear_modulus * (1 - relaxation.modulus_per_K * offset),
      glass_time_constant(T, bond.glass_transition, bond.alpha_low_activation) *
          std::exp(share),
      T, omega);
}

Complex shear_lag(Complex q) {
  // 1 - tanh(q)/q cancels for small q: its series is exact to 1e-16 there.
  if (std::abs(q) < 0.02) {
    const Complex q2 = q * q;
    return q2 * (1.0 / 3 - q2 * (2.0 / 15 - q2 * (17.0 / 315)));
  }
  return 1.0 - std::tanh(q) / q;
}

Complex shear_lag(const PatchParameters& patches, double bond_thickness,
                  Complex bond_modulus, Complex patch_modulus) {
  return shear_lag(0.5 * patches.length *
                   std::sqrt(bond_modulus / (bond_thickness * patch_modulus *
                                             patches.thickness)));
}

Complex mount_share(const MountParameters& mount, double T, double omega) {
  const Complex z = cole_cole(
      omega,
      glass_time_constant(T, mount.glass_transition, mount.low_activation),
      mount.exponent);
  return mount.glassy_stiffness_share * (mount.rubber_glass_ratio + z) /
         (1.0 + z);
}

}  // namespace beamgyro::internal
